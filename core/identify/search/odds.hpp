#pragma once

#include "core/identify/causes/cause.hpp"

namespace mpm {

/// Share of the rows that count as independent: innovations that still hang together say less than
/// their number. 1 where the noise model whitens.
[[nodiscard]] double independence(const std::vector<CvFit>& cvs);

/// 2 ln of the odds for an effect: a fit with it against one without it on the same CVs.
[[nodiscard]] double odds_for(const Effect& effect, const Fit& with, const Fit& without);

}  // namespace mpm
