#pragma once

#include <Eigen/Core>

#include "core/mismatch/channel_evidence.hpp"
#include "core/mismatch/error_reduction.hpp"
#include "core/mismatch/estimate_noise.hpp"
#include "core/mismatch/usual_error_space.hpp"

namespace mpm {

/// Whether a channel's error matters. Where errors of gain, time constant and dead time explain
/// what is seen, each is estimated and tested against its limit (one-sided t, three times). Where
/// they do not, both tests of the channel are made again of the hypothesis that the error is some
/// combination of these three within their limits: the distance from the estimate to the nearest
/// such error takes the place of the distance to none. No allocation after construction.
class Materiality {
 public:
  /// `block`: coefficients of a channel.
  explicit Materiality(int block);

  /// Estimates the three errors as if they were small; what they leave, in squares. `estimate` and
  /// `directions` (block x error_column::kCount): whitened.
  [[nodiscard]] double fit(const Eigen::VectorXd& estimate, const Eigen::MatrixXd& directions,
                           const EstimateNoise& noise, ChannelEvidence& evidence);
  /// The three errors of the last `fit`, and which way its dead time goes.
  [[nodiscard]] const ReducedErrors& fitted() const { return fitted_; }
  [[nodiscard]] int fitted_shift() const { return fitted_shift_; }
  /// What the allowed errors nearest to it leave of the last estimate that was judged; all of one
  /// that usual errors explain.
  [[nodiscard]] const Eigen::VectorXd& beside_allowed() const { return beside_allowed_; }
  /// Whether no more than noise is left of a block of so many coefficients.
  [[nodiscard]] static bool explained(double left, Eigen::Index block, const EstimateNoise& noise);
  /// p-value of |parameter| <= limit: Student's t of the excess, one-sided.
  [[nodiscard]] static double beyond(const Estimate& estimate, double limit, double freedom);
  /// `left`: by the errors in `evidence`. `usual`: the space that the directed test looks at.
  void judge(double left, const Eigen::VectorXd& estimate, const Eigen::MatrixXd& directions,
             const UsualErrorSpace& usual, const MaterialityLimits& limits,
             const EstimateNoise& noise, ChannelEvidence& evidence);

 private:
  static void judge_usual(const MaterialityLimits& limits, const EstimateNoise& noise,
                          ChannelEvidence& evidence);
  void judge_unusual(const Eigen::VectorXd& estimate, const Eigen::MatrixXd& directions,
                     const UsualErrorSpace& usual, const MaterialityLimits& limits,
                     const EstimateNoise& noise, ChannelEvidence& evidence);

  ErrorReduction reduction_;
  ReducedErrors fitted_;
  int fitted_shift_ = error_column::kLater;
  // The directions and the estimate as the directed test sees them.
  Eigen::VectorXd beside_allowed_;
  Eigen::MatrixXd usual_directions_;
  Eigen::VectorXd usual_estimate_;
};

}  // namespace mpm
