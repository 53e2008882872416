#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mismatch/block_covariance.hpp"
#include "core/mismatch/channel_evidence.hpp"
#include "core/mismatch/error_reduction.hpp"
#include "core/mismatch/input_estimates.hpp"
#include "core/mismatch/signature.hpp"
#include "core/mismatch/step_errors.hpp"
#include "core/model/linear_model.hpp"

namespace mpm {

/// How large the errors of a channel's gain, time constants and dead time are where they are no
/// longer small: Gauss-Newton on the model's step response, stretched and delayed. It is fitted to
/// the coefficients that the data gave, in the metric of their covariance. No allocation after
/// construction.
class ErrorSizes {
 public:
  ErrorSizes(const RegressionShape& shape, const LinearModel& model);

  /// Samples by which a channel could answer earlier; 0 where the model has none.
  [[nodiscard]] double dead_time(int cv, int input) const { return response(cv, input).dead_time; }
  /// Whether the model's channel has no gain but a slope.
  [[nodiscard]] bool integrates(int cv, int input) const { return response(cv, input).integrating; }

  /// A channel of the CV that `estimates` was read for.
  struct Channel {
    int cv = 0, input = 0;
    const InputEstimates& estimates;
    const BlockCovariance& covariance;  ///< of the input
    const Eigen::VectorXd& target;      ///< its coefficients, whitened
    double variance = 1.0;              ///< of these
    const StepErrors& steps;
  };
  /// Starts from the errors in `evidence`, of which a fit has left `left`, in squares, and from
  /// some large ones, until no more than `enough` is left. What fits best takes their place. What
  /// it leaves.
  double refine(const Channel& channel, double left, double enough, ChannelEvidence& evidence);
  /// The best error of the dead time alone, looked for from none and from that in `evidence`.
  struct DeadTimeAlone {
    double left = 0.0;        ///< of the target, in squares
    double step_error = 0.0;  ///< of the step response (`StepErrors`)
  };
  DeadTimeAlone dead_time_alone(const Channel& channel, const ChannelEvidence& evidence);

 private:
  struct Response {
    Eigen::VectorXd pulse, step;  // basis.length() values; empty = no channel
    double dead_time = 0.0;       // samples
    bool integrating = false;
  };
  struct Errors {  // gain, relative; ln of the time constants' ratio; dead time, samples
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    ReducedErrors reduced;
    double left = 0.0;
  };

  [[nodiscard]] const Response& response(int cv, int input) const {
    return responses_[static_cast<std::size_t>(input * cvs_ + cv)];
  }
  /// Errors before the `first` stay where they start.
  [[nodiscard]] Errors descend(const Channel& channel, const Eigen::Vector3d& start, int first = 0);
  /// Towards the inside where there is an end; by how much it has moved.
  double move(const Channel& channel, int error, Eigen::Vector3d& value) const;
  [[nodiscard]] Estimate step_error(const Channel& channel, const Errors& errors);
  /// The error of the pulse response, into `changed_`.
  void change(const Channel& channel, const Eigen::Vector3d& value);
  [[nodiscard]] Eigen::Vector3d within(const Channel& channel, const Eigen::Vector3d& value) const;
  /// What the errors leave of the target.
  double leave(const Channel& channel, const Eigen::Vector3d& value,
               Eigen::Ref<Eigen::VectorXd> out);

  int cvs_;
  BlockBasis basis_;
  std::vector<Response> responses_;  // input-major
  Signature signature_;
  ErrorReduction reduction_;
  Eigen::VectorXd changed_, work_;  // basis.length() values
  Eigen::VectorXd left_, beside_;   // block
  Eigen::MatrixXd slopes_;          // block x error_column::kCount
};

}  // namespace mpm
