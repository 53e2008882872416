#include "core/identify/valves/valve_shape.hpp"

#include <algorithm>
#include <cmath>

#include "core/identify/valves/oscillation.hpp"
#include "core/identify/valves/shapes.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// The limits of the tests' authors (shapes.hpp, oscillation.hpp).
constexpr double kTriangle = 0.6, kRelay = 0.21, kResting = 0.25, kRegular = 1.0;
constexpr int kAgreeing = 2;
/// Fewer half cycles, or samples in a cycle, show no shape.
constexpr int kFewestHalfCycles = 6;
constexpr double kShortestPeriod = 10.0;
/// Output and value swing with the same period if they differ by no more than this share.
constexpr double kSamePeriod = 0.15;
/// A set-point that swings by more than this share of what its value does drives it.
constexpr double kDriven = 0.3;

VectorXd filled(const Eigen::Ref<const VectorXd>& values) {
  VectorXd result = values;
  double last = 0.0;
  for (Index k = result.size(); k-- > 0;)
    if (std::isfinite(result(k))) last = result(k);  // the first known one
  for (double& value : result) {
    if (std::isfinite(value)) last = value;
    value = last;
  }
  return result;
}

}  // namespace

ValveShape judge_valve(const Eigen::Ref<const VectorXd>& output,
                       const Eigen::Ref<const VectorXd>& value,
                       const Eigen::Ref<const VectorXd>& setpoint, double sample_time_s) {
  ValveShape shape;
  if (value.size() < 2) return shape;
  const VectorXd op = filled(output), pv = filled(value), sp = filled(setpoint);
  const Oscillation of_output = oscillation_of(op), of_value = oscillation_of(pv);
  const double period = of_value.period;
  shape.period_s = period * sample_time_s;
  shape.regularity = std::min(of_output.regularity, of_value.regularity);
  if (!(shape.regularity > kRegular && period >= kShortestPeriod &&
        std::abs(of_output.period - period) <= kSamePeriod * period))
    return shape;

  const VectorXd swing_op = swing_of(op, period), swing_pv = swing_of(pv, period);
  const std::vector<HalfCycle> halves_op = half_cycles(swing_op, period);
  const std::vector<HalfCycle> halves_pv = half_cycles(swing_pv, period);
  shape.half_cycles = static_cast<int>(halves_pv.size());
  if (static_cast<int>(std::min(halves_op.size(), halves_pv.size())) < kFewestHalfCycles)
    return shape;

  shape.triangle =
      std::max(triangle_index(swing_op, halves_op), triangle_index(swing_pv, halves_pv));
  shape.relay = relay_index(swing_pv, halves_pv);
  shape.resting = resting_index(op, pv, period);
  shape.triangle_sticks = shape.triangle > kTriangle;
  shape.relay_sticks = shape.relay > kRelay;
  shape.resting_sticks = shape.resting > kResting;
  if (swing_of(sp, period).norm() > kDriven * swing_pv.norm())
    shape.verdict = ValveShape::Verdict::kFollows;
  else if (shape.agreeing() >= kAgreeing)
    shape.verdict = ValveShape::Verdict::kSticks;
  else
    shape.verdict =
        shape.agreeing() == 0 ? ValveShape::Verdict::kSound : ValveShape::Verdict::kUndecided;
  return shape;
}

}  // namespace mpm
