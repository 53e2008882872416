#pragma once

/// Where rounding ends what a factor can know. Derived from double precision, eps = 2.2e-16.
namespace mpm::calibration::rounding {

/// An entry of a row that is left with less than this fraction of its column's magnitude after the
/// earlier columns are rotated off is rounding noise: |x| <= 64 eps * max |x| is taken for 0.
inline constexpr double kNoise = 64 * 2.220446049250313e-16;
/// A column whose own part is below this share of its magnitude takes no part in a solution.
inline constexpr double kNegligible = 1e-7;
/// Of a stored row at least this much must be kept for r + s x' to lose no more than a digit.
inline constexpr double kMostlyKept = 0.1;

}  // namespace mpm::calibration::rounding
