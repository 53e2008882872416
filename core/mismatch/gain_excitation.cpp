#include "core/mismatch/gain_excitation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mpm {

GainExcitation::GainExcitation(const InputEstimates& estimates)
    : direction_(Eigen::MatrixXd::Zero(estimates.block(), estimates.inputs())),
      whitened_(Eigen::VectorXd::Zero(estimates.block())),
      functional_(Eigen::VectorXd::Zero(estimates.columns())),
      other_functional_(Eigen::VectorXd::Zero(estimates.columns())) {}

void GainExcitation::clear(int input, ChannelEvidence& evidence) {
  direction_.col(input).setZero();
  evidence.excitation_index = std::numeric_limits<double>::infinity();
  evidence.excitation_index_alone = std::numeric_limits<double>::infinity();
}

void GainExcitation::measure(int input, const Eigen::VectorXd& error,
                             const Eigen::VectorXd& estimate, const InputEstimates& estimates,
                             const BlockCovariance& covariance, const EstimateNoise& noise,
                             ChannelEvidence& evidence) {
  const double alone = estimates.movement(input, error, functional_);
  whitened_ = error;
  covariance.whiten(whitened_);
  const double information = whitened_.squaredNorm();
  const double spread = std::sqrt(noise.variance);
  evidence.excitation_index = spread / std::sqrt(information);
  evidence.excitation_index_alone = spread / std::sqrt(alone);
  evidence.gain_error_ratio = information > 0.0 ? whitened_.dot(estimate) / information : 0.0;
  evidence.gain_error = {evidence.gain_error_ratio, evidence.excitation_index};
  direction_.col(input) = whitened_;
  covariance.whiten_transposed(direction_.col(input));
}

void GainExcitation::measure_coupled(const Eigen::VectorXd& error, const Eigen::VectorXd& estimate,
                                     const EstimateNoise& noise, ChannelEvidence& evidence) {
  const double information = error.squaredNorm();
  const double index = std::sqrt(noise.variance / information);
  const double wider = std::max(1.0, index / evidence.excitation_index);
  evidence.excitation_index *= wider;
  evidence.excitation_index_alone *= wider;  // it is no other input that hides this one
  evidence.gain_error_ratio = information > 0.0 ? error.dot(estimate) / information : 0.0;
  evidence.gain_error = {evidence.gain_error_ratio, evidence.excitation_index};
}

void GainExcitation::functional_of(int input, const InputEstimates& estimates,
                                   Eigen::Ref<Eigen::VectorXd> functional) const {
  const int block = estimates.block();
  const int at = input * block;
  const Eigen::Index rest = functional.size() - at;
  functional.setZero();
  for (int r = 0; r < block; ++r)
    functional.tail(rest) += direction_(r, input) * Eigen::Map<const Eigen::VectorXd>(
                                                        estimates.inverse_row(at + r) + at, rest);
}

int GainExcitation::confounder(int input, const InputEstimates& estimates) {
  functional_of(input, estimates, functional_);
  double largest = 0.0;
  int found = -1;
  for (int other = 0; other < estimates.inputs(); ++other) {
    if (other == input) continue;
    functional_of(other, estimates, other_functional_);
    const double norm = other_functional_.norm();
    if (!(norm > 0.0)) continue;
    const double correlation = std::abs(functional_.dot(other_functional_)) / norm;
    if (correlation > largest) {
      largest = correlation;
      found = other;
    }
  }
  return found;
}

}  // namespace mpm
