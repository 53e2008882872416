#pragma once

#include <cstdint>

namespace mpm {

inline constexpr double kNsPerSecond = 1e9;
inline constexpr std::int64_t kSecondNs = 1'000'000'000;

/// Downwards, also of what is below 0: times before 1970. `step` > 0.
constexpr std::int64_t floor_division(std::int64_t value, std::int64_t step) {
  return value / step - (value % step < 0 ? 1 : 0);
}

}  // namespace mpm
