#pragma once

/// The numbers that decide what a trend shows and says.
namespace mpm::history {

/// Of a period's intervals at least this share must be known, or nothing is shown of it. Chosen.
inline constexpr double kLeastShare = 0.1;
/// Histories of one unit without any change of which something is said, all its channels and CVs
/// together. The p-value of each is compared with this, shared out among all that are asked.
/// Chosen; that it holds was seen on seeds from 100001 on, which score nothing (docs/trend.md).
inline constexpr double kFalseRate = 0.01;
/// Prediction errors that changed by less are not told, either way. Chosen.
inline constexpr double kLeastRatio = 1.25;
/// Up to so many days hours are shown, up to so many days are shown, then weeks. Chosen: some
/// thirty to sixty lines.
inline constexpr double kHoursUpToDays = 2.5;
inline constexpr double kDaysUpToDays = 60.0;

}  // namespace mpm::history
