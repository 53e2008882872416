#pragma once

namespace mpm {

/// Quantiles of the standard normal distribution in s.d., rounded to as many digits as are written
/// (tests/core/statistics/normal_test.cpp compares them with Boost.Math).
inline constexpr double kNormalTwoSided95 = 1.96;   ///< |z| exceeds it with probability 5 %
inline constexpr double kNormalOneSided95 = 1.645;  ///< z does
inline constexpr double kNormalOneSided99 = 2.326;  ///< with probability 1 %

}  // namespace mpm
