#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mpm::sim {

/// The first interval that is not before `time_s`; for ever stays for ever.
[[nodiscard]] inline std::int64_t interval_at(double time_s, double sample_time_s) {
  constexpr double kLast = 9e18;
  return static_cast<std::int64_t>(std::min(kLast, std::ceil(time_s / sample_time_s - 1e-9)));
}

/// The intervals from one time to another, the end left out.
struct IntervalRange {
  std::int64_t first = 0, end = 0;

  IntervalRange(double from_s, double until_s, double sample_time_s)
      : first(interval_at(from_s, sample_time_s)), end(interval_at(until_s, sample_time_s)) {}
  [[nodiscard]] bool contains(std::int64_t interval) const {
    return interval >= first && interval < end;
  }
};

}  // namespace mpm::sim
