#include "core/mismatch/step_errors.hpp"

#include <algorithm>
#include <cmath>

#include "core/mismatch/calibration.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {
namespace {

namespace window = calibration::step_errors;

// Values of a pulse response up to lag `length` - 1: all of the block's lags, then ever fewer.
std::vector<int> looked_at(int fir_lags, int length) {
  std::vector<int> lags;
  for (int lag = 1; lag < length;
       lag = lag < fir_lags ? lag + 1 : static_cast<int>(std::ceil(window::kLagRatio * lag)))
    lags.push_back(lag);
  return lags;
}

std::vector<double> roots_of_gaps(const std::vector<int>& lags) {
  std::vector<double> roots;
  int before = 0;
  for (const int lag : lags) {
    roots.push_back(std::sqrt(lag - before));
    before = lag;
  }
  return roots;
}

// The block's responses one by one: a pulse at each lag, and each tail.
std::vector<Eigen::VectorXd> unit_pulses(const RegressionShape& shape, int length) {
  std::vector<Eigen::VectorXd> pulses;
  for (int lag = 1; lag <= shape.fir_lags; ++lag)
    pulses.push_back(Eigen::VectorXd::Unit(length, lag));
  for (const double pole : shape.tail_poles) {
    Eigen::VectorXd& pulse = pulses.emplace_back(Eigen::VectorXd::Zero(length));
    double value = 1.0 - pole;
    for (int lag = shape.fir_lags + 1; lag < length; ++lag, value *= pole) pulse(lag) = value;
  }
  return pulses;
}

// Of the samples to which the response is not yet within kSettled of its last value.
double end_of(const Eigen::VectorXd& pulse) {
  Eigen::VectorXd step = pulse;
  for (Eigen::Index l = 1; l < step.size(); ++l) step(l) += step(l - 1);
  const double band = window::kSettled * step.cwiseAbs().maxCoeff();
  Eigen::Index last = step.size() - 1;
  while (last > 0 && std::abs(step(last) - step(step.size() - 1)) <= band) --last;
  return window::kBeyond * static_cast<double>(last + 1);
}

Eigen::MatrixXd triangle_of(const Eigen::MatrixXd& columns) {
  const Eigen::Index size = columns.cols();
  GivensQr factor(static_cast<int>(size), 1);
  for (Eigen::Index r = 0; r < columns.rows(); ++r) {
    double* row = factor.row();
    for (Eigen::Index c = 0; c < size; ++c) row[c] = columns(r, c);
    row[size] = 0.0;
    factor.update(1.0);
  }
  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(size, size);
  for (int r = 0; r < size; ++r)
    for (int c = r; c < size; ++c) triangle(r, c) = factor.r(r, c);
  return triangle;
}

}  // namespace

StepErrors::StepErrors(const RegressionShape& shape, const LinearModel& model)
    : cvs_(shape.cvs),
      basis_(shape.fir_lags, shape.tail_poles),
      lags_(looked_at(shape.fir_lags, basis_.length())),
      weights_(roots_of_gaps(lags_)),
      unit_steps_(static_cast<Eigen::Index>(lags_.size()), shape.block()),
      block_(shape.block()),
      usual_(kUsualErrors),
      directed_(kUsualErrors),
      unit_(Eigen::VectorXd::Zero(shape.block())),
      seen_(Eigen::MatrixXd::Zero(kUsualErrors, kUsualErrors)),
      seen_estimate_(Eigen::VectorXd::Zero(kUsualErrors)),
      feed_(shape.block() + 1),
      steps_(shape.block(), 1),
      turned_(kUsualErrors, 1) {
  for (const Eigen::VectorXd& pulse : unit_pulses(shape, basis_.length())) {
    unit_steps_.col(static_cast<Eigen::Index>(units_.size())) = sampled_step(pulse);
    units_.emplace_back(basis_, pulse, shape.residual_order, shape.residual_poles);
  }
  const Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> integrating = model.integrating();
  for (int i = 0; i < shape.inputs; ++i)
    for (int j = 0; j < shape.cvs; ++j)
      channels_.push_back(
          channel_of(model.impulse_response(j, i, basis_.length()), integrating(j, i)));
}

StepErrors::Channel StepErrors::channel_of(const Eigen::VectorXd& pulse, bool integrates) const {
  Channel channel;
  if (!(pulse.cwiseAbs().maxCoeff() > 0.0)) return channel;
  channel.end = end_of(pulse);
  const auto weighted = [&](const Eigen::VectorXd& error) {
    Eigen::VectorXd step = sampled_step(error);
    for (Eigen::Index at = 0; at < step.size(); ++at) step(at) *= weight(channel, at);
    return step;
  };
  channel.norm = weighted(pulse).norm();
  const std::vector<Eigen::VectorXd> errors = usual_errors(pulse, integrates);
  Eigen::MatrixXd steps(unit_steps_.rows(), kUsualErrors);
  for (int e = 0; e < kUsualErrors; ++e)
    steps.col(e) = weighted(errors[static_cast<std::size_t>(e)]) / channel.norm;
  channel.usual = triangle_of(steps);
  Eigen::MatrixXd three = steps.leftCols(3);
  three.col(2) = weighted(shifted(pulse, 1) - pulse) / channel.norm;
  channel.later = triangle_of(three);
  three.col(2) = weighted(shifted(pulse, -1) - pulse) / channel.norm;
  channel.earlier = triangle_of(three);
  return channel;
}

double StepErrors::weight(const Channel& channel, Eigen::Index at) const {
  const auto i = static_cast<std::size_t>(at);
  const double lag = lags_[i];
  return weights_[i] * (lag <= channel.end ? 1.0 : window::kLater * channel.end / lag);
}

Eigen::VectorXd StepErrors::sampled_step(const Eigen::VectorXd& pulse) const {
  Eigen::VectorXd step(static_cast<Eigen::Index>(lags_.size()));
  double sum = pulse(0);
  int before = 0;
  for (Eigen::Index at = 0; at < step.size(); ++at) {
    const int lag = lags_[static_cast<std::size_t>(at)];
    sum += pulse.segment(before + 1, lag - before).sum();
    before = lag;
    step(at) = sum;
  }
  return step;
}

double StepErrors::of_pulse(int cv, int input, const Eigen::VectorXd& pulse) const {
  const Channel& of = channel(cv, input);
  if (of.norm == 0.0) return 0.0;
  double square = 0.0, sum = pulse(0);
  int before = 0;
  for (std::size_t at = 0; at < lags_.size(); ++at) {
    sum += pulse.segment(before + 1, lags_[at] - before).sum();
    before = lags_[at];
    square += std::pow(sum * weight(of, static_cast<Eigen::Index>(at)), 2);
  }
  return std::sqrt(square) / of.norm;
}

Estimate StepErrors::of_fit(int cv, int input, const ReducedErrors& reduced, int shift,
                            double variance) const {
  const Channel& of = channel(cv, input);
  if (of.norm == 0.0) return {};
  const Eigen::Matrix3d& steps = shift == error_column::kEarlier ? of.earlier : of.later;
  const Eigen::Vector3d off = steps * reduced.fit();
  const double size = off.norm();
  const Eigen::Vector3d slope =
      size > 0.0 ? Eigen::Vector3d(steps.transpose() * (off / size)) : Eigen::Vector3d::Zero();
  return {size, std::sqrt(variance) * reduced.deviation_of(slope)};
}

double StepErrors::beyond(const Target& target, const InputEstimates& estimates,
                          const BlockCovariance& covariance, double limit) {
  const Channel& of = channel(target.cv, target.input);
  if (of.norm == 0.0) return 0.0;
  steps_.clear();
  const int block = steps_.columns();
  for (Eigen::Index at = 0; at < unit_steps_.rows(); ++at) {
    double* row = feed_.next_row(steps_);
    const double share = weight(of, at) / of.norm;
    for (int c = 0; c < block; ++c) row[c] = share * unit_steps_(at, c);
    row[block] = 0.0;
  }
  feed_.flush(steps_);
  for (int c = 0; c < block; ++c) {
    units_[static_cast<std::size_t>(c)].filter(estimates.own_past().data(), unit_);
    unit_.array() *= estimates.norms(target.input).array();
    covariance.whiten(unit_);
    for (int before = 0; before < c; ++before)
      unit_ -= steps_.r(before, c) * block_.responses.col(before);
    const double own = steps_.r(c, c);
    block_.responses.col(c) = unit_ * (own > 0.0 ? 1.0 / own : 0.0);
  }
  return beyond(target, block_, limit);
}

double StepErrors::beyond(const Target& target, const Eigen::MatrixXd& usual_errors, double limit) {
  const Channel& of = channel(target.cv, target.input);
  if (of.norm == 0.0) return 0.0;
  for (int c = 0; c < kUsualErrors; ++c) {
    auto response = usual_.responses.col(c);
    response = usual_errors.col(c);
    for (int before = 0; before < c; ++before)
      response -= of.usual(before, c) * usual_.responses.col(before);
    const double own = of.usual(c, c);
    response *= own > 0.0 ? 1.0 / own : 0.0;
  }
  return beyond(target, usual_, limit);
}

double StepErrors::beyond(const Target& target, Space& space, double limit) {
  constexpr double kTests = 2.0;
  const auto size = static_cast<double>(target.estimate.size());
  const double whole = space.nearest.distance_square(space.responses, target.estimate, limit) /
                       (size * target.noise.block_variance);
  const double whole_p = f_upper_tail(whole, size, target.noise.freedom);
  const int rank = target.usual.rank();
  if (rank == 0) return whole_p;
  turned_.clear();
  for (Eigen::Index c = 0; c < space.responses.cols(); ++c) {
    double* row = feed_.next_row(turned_);
    std::fill(row, row + kUsualErrors + 1, 0.0);
    target.usual.coordinates(space.responses.col(c), Eigen::Map<Eigen::VectorXd>(row, rank));
  }
  feed_.flush(turned_);
  for (int r = 0; r < kUsualErrors; ++r)
    for (int c = 0; c < kUsualErrors; ++c) seen_(c, r) = c < r ? 0.0 : turned_.r(r, c);
  seen_estimate_.setZero();
  target.usual.coordinates(target.estimate, seen_estimate_.head(rank));
  const double directed =
      directed_.distance_square(seen_, seen_estimate_, limit) / (rank * target.noise.variance);
  const double directed_p = f_upper_tail(directed, rank, target.noise.freedom);
  return std::min(1.0, kTests * std::min(whole_p, directed_p));
}

}  // namespace mpm
