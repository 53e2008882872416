#pragma once

#include <limits>

namespace mpm::config {

/// The numbers that a key accepts.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;

  [[nodiscard]] bool contains(double value) const {
    return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
  }
};

inline constexpr Range kAny{};
inline constexpr Range kPositive{.low = 0.0, .low_open = true};
inline constexpr Range kNotNegative{.low = 0.0};
inline constexpr Range kRatio{.low = 0.0, .high = 1.0, .low_open = true, .high_open = true};

}  // namespace mpm::config
