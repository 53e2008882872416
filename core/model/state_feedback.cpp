#include "core/model/state_feedback.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace mpm {
namespace {

/// Smallest z > 0 at which 1 + 2 a z + 3 b z^2 = 0, infinity where there is none.
double first_turn(double a, double b) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double discriminant = a * a - 3.0 * b;
  if (discriminant < 0.0) return kNever;
  const double q = -(a + std::copysign(std::sqrt(discriminant), a));
  double first = kNever;
  if (q != 0.0 && 1.0 / q > 0.0) first = 1.0 / q;
  if (b != 0.0 && q / (3.0 * b) > 0.0) first = std::min(first, q / (3.0 * b));
  return first;
}

}  // namespace

StateFeedback::StateFeedback(const StateBlock& block, const ChannelFacts& facts,
                             double output_origin, double sample_time_s)
    : block_(block), gain_(facts.gain), integrating_(facts.integrating) {
  if (const auto* force = std::get_if<RestoringForce>(&block_)) {
    if (!std::isfinite(force->quadratic) || !std::isfinite(force->cubic))
      throw std::invalid_argument("restoring force: coefficients must be finite");
  } else if (const auto* outflow = std::get_if<SquareRootOutflow>(&block_)) {
    height_ = output_origin - outflow->empty_output;
    if (!std::isfinite(height_) || height_ == 0.0)
      throw std::invalid_argument("square root outflow: empty at the operating point");
    if (integrating_ || !std::isfinite(gain_) || gain_ == 0.0)
      throw std::invalid_argument("square root outflow: the channel has no steady-state gain");
  } else {
    const auto& friction = std::get<CoulombFriction>(block_);
    if (!(std::isfinite(friction.force) && friction.force >= 0.0))
      throw std::invalid_argument("Coulomb friction: force must not be negative");
    if (!(std::isfinite(friction.speed) && friction.speed > 0.0))
      throw std::invalid_argument("Coulomb friction: speed must be positive");
    step_ = friction.speed * sample_time_s;
  }
}

double StateFeedback::value(double output, double previous) const {
  if (const auto* force = std::get_if<RestoringForce>(&block_))
    return output * output * (force->quadratic + force->cubic * output);
  if (std::holds_alternative<SquareRootOutflow>(block_)) {
    const double level = 1.0 + output / height_;
    const double flow = std::copysign(std::sqrt(std::abs(level)), level);
    return (2.0 * height_ * (flow - 1.0) - output) / gain_;
  }
  return std::get<CoulombFriction>(block_).force * std::tanh((output - previous) / step_);
}

double StateFeedback::rest(double input) const {
  if (integrating_) return 0.0;
  if (const auto* force = std::get_if<RestoringForce>(&block_))
    return restoring_rest(*force, input);
  if (std::holds_alternative<SquareRootOutflow>(block_)) {
    const double flow = 1.0 + gain_ * input / (2.0 * height_);
    return height_ * (flow * std::abs(flow) - 1.0);
  }
  return gain_ * input;
}

/// With z = |y| and t = |gain input|: z + a z^2 + b z^3 = t rises from z = 0 up to its first turn.
double StateFeedback::restoring_rest(const RestoringForce& force, double input) const {
  const double target = gain_ * input;
  const double t = std::abs(target);
  if (!(t > 0.0) || !std::isfinite(t)) return 0.0;
  const double a = std::copysign(1.0, target) * gain_ * force.quadratic;
  const double b = gain_ * force.cubic;
  const auto missing = [&](double z) { return z * (1.0 + z * (a + z * b)) - t; };
  double low = 0.0;
  double high = first_turn(a, b);
  if (std::isfinite(high)) {
    if (missing(high) <= 0.0) return std::copysign(high, target);
  } else {
    high = t;
    while (missing(high) < 0.0) high *= 2.0;
  }
  double z = std::min(t, 0.5 * high);
  constexpr int kMostSteps =
      200;  // bisection alone needs 60 for all bits and as many for the range
  for (int i = 0; i < kMostSteps; ++i) {
    const double error = missing(z);
    (error > 0.0 ? high : low) = z;
    const double slope = 1.0 + z * (2.0 * a + 3.0 * b * z);
    double next = z - error / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == z || error == 0.0) break;
    z = next;
  }
  return std::copysign(z, target);
}

}  // namespace mpm
