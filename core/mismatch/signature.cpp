#include "core/mismatch/signature.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {

using calibration::usual_errors::kDelayShifts;
using calibration::usual_errors::kTailFitFewest;
using calibration::usual_errors::kTailFitMost;
using calibration::usual_errors::kTailFitTimeConstants;
using calibration::usual_errors::kTimeConstantStep;

namespace {

double slowest_of(const std::vector<double>& tail_poles) {
  return -1.0 / std::log(*std::max_element(tail_poles.begin(), tail_poles.end()));
}

}  // namespace

// As many as there are tails at least: one that takes for ever brings hundreds, and its pole,
// rounded to 1, no time constant.
int BlockBasis::lags_beyond(const std::vector<double>& tail_poles) {
  const int fewest = std::max(kTailFitFewest, static_cast<int>(tail_poles.size()));
  return static_cast<int>(std::clamp<double>(kTailFitTimeConstants * slowest_of(tail_poles), fewest,
                                             kTailFitMost));  // an int need not hold the slowest
}

BlockBasis::BlockBasis(int fir_lags, std::vector<double> tail_poles)
    : fir_lags_(fir_lags), tail_poles_(std::move(tail_poles)) {
  slowest_ = slowest_of(tail_poles_);
  beyond_ = lags_beyond(tail_poles_);
  Eigen::MatrixXd steps(beyond_, static_cast<Eigen::Index>(tail_poles_.size()));
  for (Eigen::Index t = 0; t < steps.cols(); ++t)
    for (int l = 0; l < beyond_; ++l)
      steps(l, t) = 1.0 - std::pow(tail_poles_[static_cast<std::size_t>(t)], l + 1);
  tail_fit_.compute(steps);
  // R^-1 Q', Q's first columns alone.
  projection_ =
      (tail_fit_.householderQ() * Eigen::MatrixXd::Identity(beyond_, steps.cols())).transpose();
  tail_fit_.matrixQR()
      .topRows(steps.cols())
      .triangularView<Eigen::Upper>()
      .solveInPlace(projection_);
}

Eigen::VectorXd BlockBasis::tail_coefficients(const Eigen::VectorXd& pulse, int shift) const {
  Eigen::VectorXd step(beyond_);
  sum_beyond(pulse, shift, step);
  return tail_fit_.solve(step);
}

void BlockBasis::tail_coefficients(const Eigen::VectorXd& pulse, int shift, Eigen::VectorXd& work,
                                   Eigen::Ref<Eigen::VectorXd> out) const {
  sum_beyond(pulse, shift, work.head(beyond_));
  out.noalias() = projection_ * work.head(beyond_);
}

void BlockBasis::sum_beyond(const Eigen::VectorXd& pulse, int shift,
                            Eigen::Ref<Eigen::VectorXd> step) const {
  double sum = 0.0;
  for (int l = 0; l < beyond_; ++l) {
    const int at = fir_lags_ + 1 + l - shift;
    sum += at >= 0 ? pulse(at) : 0.0;
    step(l) = sum;
  }
}

Signature::Signature(const BlockBasis& basis, const Eigen::VectorXd& pulse, int order,
                     const std::vector<double>& means)
    : poles_(means),
      mean_(means.empty() ? 0 : basis.length()),
      means_(basis.fir_lags(), static_cast<Eigen::Index>(means.size())),
      tails_(basis.columns() - basis.fir_lags(), 1 + order + means_.cols()) {
  Eigen::VectorXd work(basis.length());
  replace(basis, pulse, work);
}

void Signature::replace(const BlockBasis& basis, const Eigen::VectorXd& pulse,
                        Eigen::VectorXd& work) {
  pulse_ = pulse.segment(1, basis.fir_lags());
  for (Eigen::Index shift = 0; shift <= order(); ++shift)
    basis.tail_coefficients(pulse, static_cast<int>(shift), work, tails_.col(shift));
  const Eigen::Index delay = order() + 1;
  for (Eigen::Index t = 0; t < means_.cols(); ++t) {
    const double pole = poles_[static_cast<std::size_t>(t)];
    mean_.setZero();
    for (Eigen::Index l = delay; l < mean_.size(); ++l)
      mean_(l) = pole * mean_(l - 1) + (1.0 - pole) * pulse(l - delay);
    means_.col(t) = mean_.segment(1, basis.fir_lags());
    basis.tail_coefficients(mean_, 0, work, tails_.col(delay + t));
  }
}

void Signature::filter(const double* a, Eigen::Ref<Eigen::VectorXd> coefficients) const {
  const Eigen::Index lags = pulse_.size();
  coefficients.head(lags) = pulse_;
  coefficients.tail(tails_.rows()) = tails_.col(0);
  for (Eigen::Index shift = 1; shift < tails_.cols(); ++shift) {
    const double share = a[shift - 1];
    if (shift > order())
      coefficients.head(lags) -= share * means_.col(shift - order() - 1);
    else if (shift < lags)
      coefficients.segment(shift, lags - shift) -= share * pulse_.head(lags - shift);
    coefficients.tail(tails_.rows()) -= share * tails_.col(shift);
  }
}

Eigen::VectorXd shifted(const Eigen::VectorXd& pulse, int by) {
  const auto length = pulse.size();
  Eigen::VectorXd result = Eigen::VectorXd::Zero(length);
  for (Eigen::Index l = 1; l < length; ++l)
    if (l - by >= 0 && l - by < length) result(l) = pulse(l - by);
  return result;
}

std::vector<Eigen::VectorXd> usual_errors(const Eigen::VectorXd& pulse, bool integrating) {
  const int length = static_cast<int>(pulse.size());
  // Step response stretched about the end of the dead time, by linear interpolation.
  int start = 0;
  while (start + 1 < length && pulse(start + 1) == 0.0) ++start;
  Eigen::VectorXd step(length);
  double sum = 0.0;
  for (int l = 0; l < length; ++l) step(l) = sum += pulse(l);
  const auto stretched = [&](int l) {
    const double at = l <= start ? l : start + (l - start) / (1.0 + kTimeConstantStep);
    const int below = std::min(static_cast<int>(at), length - 2);
    const double value = step(below) + (at - below) * (step(below + 1) - step(below));
    return integrating ? (1.0 + kTimeConstantStep) * value : value;
  };
  Eigen::VectorXd slower = Eigen::VectorXd::Zero(length);
  for (int l = 1; l < length; ++l)
    slower(l) = (stretched(l) - stretched(l - 1) - pulse(l)) / std::log(1.0 + kTimeConstantStep);
  // Of an integrator without lag nothing is slower; what rounding leaves is no direction.
  if (slower.norm() <= calibration::rounding::kIndependentShare * pulse.norm()) slower.setZero();
  std::vector<Eigen::VectorXd> errors = {pulse, slower};
  for (const int shift : kDelayShifts) errors.push_back(shifted(pulse, shift));
  return errors;
}

}  // namespace mpm
