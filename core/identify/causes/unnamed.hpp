#pragma once

#include <vector>

#include "core/identify/fit/effect.hpp"
#include "core/identify/fit/problem.hpp"

namespace mpm {

/// What a channel may do that no cause of the contract means: its gain moves with another input,
/// swings with time, or it rises slower than it falls. Such an effect competes with all others, so
/// that what has no name is not given the name of whatever comes nearest; it repairs nothing.
/// `without` is the fit of one CV with `accepted` alone.
[[nodiscard]] std::vector<Effect> unnamed_candidates(Problem& problem,
                                                     const std::vector<Effect>& accepted,
                                                     const CvFit& without);

}  // namespace mpm
