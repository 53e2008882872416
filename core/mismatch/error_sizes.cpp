#include "core/mismatch/error_sizes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/mismatch/calibration.hpp"

namespace mpm {

namespace sizes = calibration::error_sizes;

ErrorSizes::ErrorSizes(const RegressionShape& shape, const LinearModel& model)
    : cvs_(shape.cvs),
      basis_(shape.fir_lags, shape.tail_poles),
      signature_(basis_, Eigen::VectorXd::Zero(basis_.length()), shape.residual_order,
                 shape.residual_poles),
      reduction_(shape.block()),
      changed_(Eigen::VectorXd::Zero(basis_.length())),
      work_(changed_),
      left_(Eigen::VectorXd::Zero(shape.block())),
      beside_(left_),
      slopes_(Eigen::MatrixXd::Zero(shape.block(), error_column::kCount)) {
  const Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> integrating = model.integrating();
  for (int i = 0; i < shape.inputs; ++i) {
    for (int j = 0; j < shape.cvs; ++j) {
      Response& response = responses_.emplace_back();
      Eigen::VectorXd pulse = model.impulse_response(j, i, basis_.length());
      if (!(pulse.cwiseAbs().maxCoeff() > 0.0)) continue;
      response.step = pulse;
      for (Eigen::Index l = 1; l < pulse.size(); ++l) response.step(l) += response.step(l - 1);
      response.pulse = std::move(pulse);
      Eigen::Index dead = 0;
      while (dead + 2 < response.pulse.size() && response.pulse(dead + 1) == 0.0) ++dead;
      response.dead_time = static_cast<double>(dead);
      response.integrating = integrating(j, i);
    }
  }
}

double ErrorSizes::refine(const Channel& channel, double left, double enough,
                          ChannelEvidence& evidence) {
  if (response(channel.cv, channel.input).pulse.size() == 0) return left;
  const Eigen::Vector3d linear(evidence.gain_error.value, evidence.log_time_error.value,
                               evidence.dead_time_error.value);
  Errors best;
  best.left = left;
  const auto try_from = [&](const Eigen::Vector3d& start) {
    const Errors errors = descend(channel, start);
    if (errors.left < best.left) best = errors;
  };
  try_from(linear.allFinite() ? linear : Eigen::Vector3d::Zero());
  for (const std::array<double, 2>& start : sizes::kStarts) {
    if (best.left <= enough) break;
    try_from({0.0, start[0], start[1]});
  }
  if (!(best.left < left)) return left;
  const Eigen::Vector3d deviation = std::sqrt(channel.variance) * best.reduced.deviations();
  evidence.gain_error = {best.value(0), deviation(0)};
  evidence.log_time_error = {best.value(1), deviation(1)};
  evidence.dead_time_error = {best.value(2), deviation(2)};
  evidence.step_error = step_error(channel, best);
  return best.left;
}

ErrorSizes::DeadTimeAlone ErrorSizes::dead_time_alone(const Channel& channel,
                                                      const ChannelEvidence& evidence) {
  const Errors from_none = descend(channel, Eigen::Vector3d::Zero(), error_column::kLater);
  const Errors from_found =
      descend(channel, {0.0, 0.0, evidence.dead_time_error.value}, error_column::kLater);
  const Errors& best = from_found.left < from_none.left ? from_found : from_none;
  change(channel, best.value);
  return {best.left, channel.steps.of_pulse(channel.cv, channel.input, changed_)};
}

ErrorSizes::Errors ErrorSizes::descend(const Channel& channel, const Eigen::Vector3d& start,
                                       int first) {
  Errors now;
  now.value = within(channel, start);
  now.left = leave(channel, now.value, left_);
  for (int step = 0; step < sizes::kMostSteps; ++step) {
    slopes_.leftCols(first).setZero();
    for (int e = first; e < 3; ++e) {
      Eigen::Vector3d moved = now.value;
      const double by = move(channel, e, moved);
      leave(channel, moved, beside_);
      slopes_.col(e) = (left_ - beside_) / by;
    }
    now.reduced = reduction_.reduce(left_, slopes_, error_column::kLater);
    const ReducedErrors& reduced = now.reduced;
    Eigen::Vector3d towards = Eigen::Vector3d::Zero();
    for (int i = 2; i >= 0; --i)
      if (reduced.r(i, i) > 0.0)
        towards(i) = (reduced.c(i) - reduced.r.row(i).tail(2 - i).dot(towards.tail(2 - i))) /
                     reduced.r(i, i);
    const double before = now.left;
    for (int halving = 0; halving <= sizes::kMostHalvings; ++halving, towards *= 0.5) {
      const Eigen::Vector3d tried = within(channel, now.value + towards);
      const double left = leave(channel, tried, beside_);
      if (!(left < now.left)) continue;
      now.value = tried;
      now.left = left;
      left_ = beside_;
      break;
    }
    if (before - now.left < sizes::kWorthAnotherStep * channel.variance) break;
  }
  return now;
}

double ErrorSizes::move(const Channel& channel, int error, Eigen::Vector3d& value) const {
  const double from = value(error);
  const double size = sizes::kSlopeSteps[static_cast<std::size_t>(error)];
  value(error) += size;
  if (within(channel, value)(error) != value(error)) value(error) = from - size;
  return value(error) - from;
}

Estimate ErrorSizes::step_error(const Channel& channel, const Errors& errors) {
  const auto size = [&](const Eigen::Vector3d& value) {
    change(channel, value);
    return channel.steps.of_pulse(channel.cv, channel.input, changed_);
  };
  const double own = size(errors.value);
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  for (int e = 0; e < 3; ++e) {
    Eigen::Vector3d moved = errors.value;
    const double by = move(channel, e, moved);
    slope(e) = (size(moved) - own) / by;
  }
  return {own, std::sqrt(channel.variance) * errors.reduced.deviation_of(slope)};
}

Eigen::Vector3d ErrorSizes::within(const Channel& channel, const Eigen::Vector3d& value) const {
  return {std::clamp(value(0), -sizes::kMostGain, sizes::kMostGain),
          std::clamp(value(1), -sizes::kMostLogTime, sizes::kMostLogTime),
          std::clamp(value(2), -response(channel.cv, channel.input).dead_time,
                     static_cast<double>(basis_.fir_lags()))};
}

void ErrorSizes::change(const Channel& channel, const Eigen::Vector3d& value) {
  const Response& model = response(channel.cv, channel.input);
  const double dead = model.dead_time, slower = std::exp(-value(1));
  // An integrator with longer lags rises as steeply in the end.
  const double gain = (1.0 + value(0)) * (model.integrating ? std::exp(value(1)) : 1.0);
  const auto last = model.step.size() - 1;
  const auto step_at = [&](double lag) {
    const double at = dead + (lag - dead - value(2)) * slower;
    if (at <= dead) return 0.0;
    if (at >= static_cast<double>(last))  // settled, or it goes on as it did
      return model.step(last) + (at - static_cast<double>(last)) * model.pulse(last);
    const auto below = static_cast<Eigen::Index>(at);
    return model.step(below) +
           (at - static_cast<double>(below)) * (model.step(below + 1) - model.step(below));
  };
  double before = step_at(0.0);
  for (Eigen::Index l = 1; l <= last; ++l) {
    const double now = step_at(static_cast<double>(l));
    changed_(l) = gain * (now - before) - model.pulse(l);
    before = now;
  }
}

double ErrorSizes::leave(const Channel& channel, const Eigen::Vector3d& value,
                         Eigen::Ref<Eigen::VectorXd> out) {
  change(channel, value);
  signature_.replace(basis_, changed_, work_);
  signature_.filter(channel.estimates.own_past().data(), out);
  out.array() *= channel.estimates.norms(channel.input).array();
  channel.covariance.whiten(out);
  out = channel.target - out;
  return out.squaredNorm();
}

}  // namespace mpm
