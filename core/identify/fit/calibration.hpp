#pragma once

/// Numbers that decide how a fit goes, none of which a user sets. Shares and counts are judged from
/// what they mean; where they were tried, any value within a factor of two does.
namespace mpm {

/// Two values of a plateau differ by no more than this share of what the CV moves.
inline constexpr double kPlateauTie = 1e-9;

}  // namespace mpm
