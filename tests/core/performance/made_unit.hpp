#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/performance/performance_meter.hpp"

namespace mpm::test {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Two MVs and one CV: between 0 and 100, and without limits; the CV between -0.5 and 1.
inline PerformanceSetup made_setup() {
  return {{2, 0, 1, 0}, {{0.0, 100.0}, {}}, {{-0.5, 1.0}}, {1, 5}};
}

/// A frame whose values are all good; NaN is not known.
inline Frame made_frame(std::int64_t interval, double u1, double u2, double y, double setpoint) {
  Frame frame(made_setup().counts);
  for (SignalBlock& block : frame.blocks)
    std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
  frame.interval = interval;
  frame.source_time_ns = interval * std::int64_t{1'000'000'000};
  frame[SignalKind::kMv].values << u1, u2;
  frame[SignalKind::kCv].values << y;
  frame[SignalKind::kSetpoint].values << setpoint;
  return frame;
}

/// sin of so many samples, with so many samples a period.
inline double sine(std::int64_t k, double period) {
  return std::sin(2.0 * std::numbers::pi * static_cast<double>(k) / period);
}

}  // namespace mpm::test
