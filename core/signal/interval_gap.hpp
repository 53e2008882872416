#pragma once

#include <cstdint>

#include "core/signal/calibration.hpp"
#include "core/signal/saturated.hpp"

namespace mpm {

/// Intervals between two numbers of one counter, any two. 0 where the second does not count on from
/// the first: it goes back, or leaps farther than any absence is long.
[[nodiscard]] inline std::uint64_t missing_between(std::int64_t last, std::int64_t next) {
  const std::int64_t step = saturated_difference(next, last);
  return step > 1 && step <= calibration::alignment::kLongestGap
             ? static_cast<std::uint64_t>(step - 1)
             : 0;
}

}  // namespace mpm
