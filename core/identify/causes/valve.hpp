#pragma once

#include <vector>

#include "core/identify/causes/cause.hpp"

namespace mpm::causes {

/// How the numbers of play and sticking are stepped about.
[[nodiscard]] Stepping width_stepping(const Effect& mine);
/// Each number larger and smaller by the share `reach`.
[[nodiscard]] Effect other_width(const Effect& mine, double reach, int index);

/// All sticking of one input near a width (input units), from `mine` on: how far a valve slips
/// shows in few rows, so that from coarse starts the fit ends in plain play. Like the first
/// sticking that was tried for this input, from the start or from later on too; none if none was.
[[nodiscard]] std::vector<Effect> sticking_near(const Effect& mine, double width,
                                                const std::vector<Effect>& tried);

}  // namespace mpm::causes
