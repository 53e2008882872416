#pragma once

#include "core/identify/fit/problem.hpp"

namespace mpm {

/// 2 ln of the prior odds against any one kind of cause: errors of channels are what one expects.
[[nodiscard]] double rarity(Cause cause);

/// Slow and without an edge, so that a noise model can take it for its own.
[[nodiscard]] bool may_pass_for_noise(const Subject& subject);

/// Such a cause is taken if re-estimated noise models speak no more than this against it.
constexpr double kWanderingNoise = -10.0;

/// Share of the rows that count as independent: innovations that still hang together say less than
/// their number. 1 where the noise model whitens.
[[nodiscard]] double independence(const std::vector<CvFit>& cvs);

/// 2 ln of the odds for an effect: a fit with it against one without it on the same CVs.
[[nodiscard]] double odds_for(const Effect& effect, const Fit& with, const Fit& without);

}  // namespace mpm
