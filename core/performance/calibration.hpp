#pragma once

#include <cstdint>

/// The numbers of this room that decide what is said. All chosen.
namespace mpm::calibration::performance {

/// A value this near to a limit is at it, share of the range between both: controllers clamp to a
/// rounded or slightly narrower limit, and positions are measured with noise. With one limit alone
/// there is no range, and only what is there or beyond counts.
inline constexpr double kAtLimitShare = 0.005;

/// The longest horizon of a prediction, samples: bounds memory to 0.2 MB a CV. Four hours of a unit
/// of one second.
inline constexpr std::int64_t kLongestHorizon = 14400;

/// A sliding window is made of so many equal blocks of sums: a shift of eight hours is told anew
/// each ten minutes.
inline constexpr int kBlocks = 48;
/// It has at least so many samples: fewer make no share and no variance worth telling.
inline constexpr std::int64_t kFewestSamples = 100;
/// And at most so many: no whole number overflows.
inline constexpr double kMostSamples = 1e9;

}  // namespace mpm::calibration::performance
