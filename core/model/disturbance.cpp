#include "core/model/disturbance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace mpm {
namespace {

/// Response to a unit step `since_s` ago.
double lagged_step(double since_s, double time_constant_s, double tolerance_s) {
  if (since_s < -tolerance_s) return 0.0;
  return time_constant_s > 0.0 ? -std::expm1(-std::max(0.0, since_s) / time_constant_s) : 1.0;
}

/// What is left of it then.
double passing(double since_s, double decay_s) {
  return std::isfinite(decay_s) ? std::exp(-std::max(0.0, since_s) / decay_s) : 1.0;
}

}  // namespace

void check_disturbance(const DisturbanceTerm& disturbance) {
  if (!std::isfinite(disturbance.onset_s) || !std::isfinite(disturbance.size))
    throw std::invalid_argument("disturbance: onset and size must be finite");
  if (!(disturbance.time_constant_s >= 0.0 && std::isfinite(disturbance.time_constant_s)))
    throw std::invalid_argument("disturbance: time constant must not be negative");
  if (!(disturbance.decay_s > 0.0))
    throw std::invalid_argument("disturbance: decay must be positive");
  if (disturbance.shape == DisturbanceShape::kPeriodic &&
      !(disturbance.period_s > 0.0 && std::isfinite(disturbance.period_s)))
    throw std::invalid_argument("disturbance: period must be positive");
  if (!(disturbance.until_s > disturbance.onset_s))
    throw std::invalid_argument("disturbance: ends before its onset");
}

double disturbance_at(const DisturbanceTerm& disturbance, double time_s, double tolerance_s) {
  const double since_s = time_s - disturbance.onset_s;
  switch (disturbance.shape) {
    case DisturbanceShape::kStep:
      return disturbance.size * passing(since_s, disturbance.decay_s) *
             (lagged_step(since_s, disturbance.time_constant_s, tolerance_s) -
              lagged_step(time_s - disturbance.until_s, disturbance.time_constant_s, tolerance_s));
    case DisturbanceShape::kDrift:
      return disturbance.size *
             std::max(0.0, std::min(time_s, disturbance.until_s) - disturbance.onset_s);
    case DisturbanceShape::kPeriodic:
      if (disturbance.square) {
        const double phase = std::remainder(since_s + tolerance_s, disturbance.period_s);
        return phase >= 0.0 ? disturbance.size : -disturbance.size;
      }
      // The remainder first: far from the onset the angle would lose its digits.
      return disturbance.size *
             std::sin(2.0 * std::numbers::pi * std::remainder(since_s, disturbance.period_s) /
                      disturbance.period_s);
  }
  return 0.0;
}

}  // namespace mpm
