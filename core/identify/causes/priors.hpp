#pragma once

#include <cmath>

/// How likely the causes are before any data, in 2 ln of odds. Judged, not fitted: errors of
/// channels are what one expects of a model; any other kind of trouble is a twelfth as likely, and
/// a plant that is another one inside half of that.
namespace mpm {

inline const double kNoRarity = 0.0;
inline const double kUsualRarity = 2.0 * std::log(12.0);
inline const double kStateRarity = 2.0 * std::log(24.0);
/// On top, for a set-point that acts on a CV by itself: it moves nothing but the controller, unless
/// somebody wired it elsewhere. Whatever the controller moves follows it, and looks like it.
inline const double kSetpointRarity = 2.0 * std::log(10.0);
/// A name is better than none.
inline const double kUnnamedRarity = 2.0 * std::log(1000.0);

/// Beyond any value that a number of an effect takes; the larger one for sizes without a scale.
inline constexpr double kUnbounded = 1e9;
inline constexpr double kUnboundedSize = 1e12;
/// No limit at all.
inline constexpr double kNoLimit = 1e300;

}  // namespace mpm
