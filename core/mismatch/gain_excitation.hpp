#pragma once

#include <Eigen/Core>

#include "core/mismatch/block_covariance.hpp"
#include "core/mismatch/channel_evidence.hpp"
#include "core/mismatch/estimate_noise.hpp"
#include "core/mismatch/input_estimates.hpp"

namespace mpm {

/// How well errors of the gains of one CV's channels would show, and which input hides them. No
/// allocation after construction.
class GainExcitation {
 public:
  explicit GainExcitation(const InputEstimates& estimates);

  /// The input says nothing.
  void clear(int input, ChannelEvidence& evidence);
  /// `error`: scaled coefficients of a gain error of 100 %; `estimate`: the input's, whitened.
  void measure(int input, const Eigen::VectorXd& error, const Eigen::VectorXd& estimate,
               const InputEstimates& estimates, const BlockCovariance& covariance,
               const EstimateNoise& noise, ChannelEvidence& evidence);
  /// What is left of that where channels of other CVs are free as well: `error` and `estimate` are
  /// whitened by all of these.
  static void measure_coupled(const Eigen::VectorXd& error, const Eigen::VectorXd& estimate,
                              const EstimateNoise& noise, ChannelEvidence& evidence);
  /// The input whose estimate is most correlated with this one's, -1 if none. After each input was
  /// measured or cleared.
  [[nodiscard]] int confounder(int input, const InputEstimates& estimates);

 private:
  /// The gain-error estimate of an input as weights on the factor's rotated responses; two such
  /// estimates are correlated as these vectors are.
  void functional_of(int input, const InputEstimates& estimates,
                     Eigen::Ref<Eigen::VectorXd> functional) const;

  Eigen::MatrixXd direction_;  // block x inputs: weights of the gain-error estimate on the block
  Eigen::VectorXd whitened_;
  Eigen::VectorXd functional_, other_functional_;
};

}  // namespace mpm
