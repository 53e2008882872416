#pragma once

#include <vector>

#include "core/identify/fit/effect.hpp"
#include "core/identify/fit/problem.hpp"

namespace mpm {

/// Disturbances that switch to and fro, as a limit cycle elsewhere does: the best of all periods
/// and phases. In the innovations they are pulses, which no periodogram shows.
[[nodiscard]] std::vector<Effect> square_waves(const Problem& problem, const CvFit& without);

/// Whether this is one of them, with `begin`, `period` and `size`.
[[nodiscard]] bool is_square_wave(const Effect& effect);

/// The same wave begun a little earlier or later, or a little longer or shorter in its period, so
/// that its edges move by up to `reach` rows.
[[nodiscard]] std::vector<Effect> other_edges(const Effect& effect, double reach,
                                              const Problem& problem);

}  // namespace mpm
