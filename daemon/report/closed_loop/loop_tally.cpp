#include "daemon/report/closed_loop/loop_tally.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace mpm::report {
namespace {

/// A solver stops this close to a limit, as a share of the range.
constexpr double kTouching = 1e-6;

bool touches(double value, const config::MvLimits& limits) {
  const double range = limits.low && limits.high
                           ? *limits.high - *limits.low
                           : std::abs(limits.low.value_or(limits.high.value_or(1.0)));
  const double close = kTouching * std::max(range, 1e-9);
  return (limits.low && value <= *limits.low + close) ||
         (limits.high && value >= *limits.high - close);
}

}  // namespace

std::vector<config::MvLimits> limits_in(const config::UnitConfig& unit,
                                        const config::ScenarioConfig& scenario) {
  std::vector<config::MvLimits> limits = unit.simulation.mv_limits;
  limits.resize(unit.mv.size());
  for (const config::MvLimitChange& change : scenario.mv_limits) {
    const auto same = [&](const config::InputSignal& mv) { return mv.tag == change.mv; };
    const auto mv = std::find_if(unit.mv.begin(), unit.mv.end(), same) - unit.mv.begin();
    if (mv == static_cast<std::ptrdiff_t>(unit.mv.size())) continue;
    config::MvLimits& own = limits[static_cast<std::size_t>(mv)];
    const double origin = unit.model.input_origin(mv);
    if (own.low) own.low = origin + change.ratio * (*own.low - origin);
    if (own.high) own.high = origin + change.ratio * (*own.high - origin);
    if (change.low) own.low = change.low;
    if (change.high) own.high = change.high;
  }
  return limits;
}

LoopTally::LoopTally(const config::UnitConfig& unit, std::vector<config::MvLimits> limits)
    : limits_(std::move(limits)), errors_(unit.cv.size()), resting_(unit.mv.size()) {}

void LoopTally::add(const Frame& frame) {
  for (std::size_t cv = 0; cv < errors_.size(); ++cv) {
    const auto i = static_cast<int>(cv);
    if (!frame[SignalKind::kCv].usable(i) || !frame[SignalKind::kSetpoint].usable(i)) continue;
    const double error = frame[SignalKind::kSetpoint].values(i) - frame[SignalKind::kCv].values(i);
    errors_[cv].count += 1.0;
    errors_[cv].sum += error;
    errors_[cv].squares += error * error;
  }
  for (std::size_t mv = 0; mv < resting_.size(); ++mv) {
    const auto i = static_cast<int>(mv);
    if (!frame[SignalKind::kMv].usable(i)) continue;
    resting_[mv].count += 1.0;
    if (touches(frame[SignalKind::kMv].values(i), limits_[mv])) resting_[mv].sum += 1.0;
  }
}

double LoopTally::error_variance(int cv) const {
  const Sum& sum = errors_.at(static_cast<std::size_t>(cv));
  if (sum.count == 0.0) return std::numeric_limits<double>::quiet_NaN();
  const double mean = sum.sum / sum.count;
  return sum.squares / sum.count - mean * mean;
}

double LoopTally::at_limit(int mv) const {
  const Sum& sum = resting_.at(static_cast<std::size_t>(mv));
  return sum.count > 0.0 ? sum.sum / sum.count : 0.0;
}

}  // namespace mpm::report
