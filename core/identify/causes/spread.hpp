#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace mpm {

/// Where a signal mostly is.
struct Spread {
  double low = 0.0, high = 0.0;  ///< 1 and 99 % quantiles
  double sd = 0.0, median = 0.0;
  std::vector<double> sorted;  ///< all that is known of it

  [[nodiscard]] double quantile(double p) const {
    return sorted[static_cast<std::size_t>(p * static_cast<double>(sorted.size() - 1))];
  }
  [[nodiscard]] double range() const { return high - low; }
  /// How far it goes from there.
  [[nodiscard]] double reach_from(double origin) const {
    return std::max(std::abs(high - origin), std::abs(low - origin));
  }
  /// Values that it rests at or passes, as far as they can be told apart: a binary test signal has
  /// two. So many at most as there are steps in its range.
  [[nodiscard]] int levels() const;
};

/// Nothing where fewer than 20 values are known or the signal hardly moves.
[[nodiscard]] std::optional<Spread> spread_of(const Eigen::Ref<const Eigen::VectorXd>& values);

}  // namespace mpm
