#pragma once

#include <vector>

#include "core/identify/fit/effect.hpp"
#include "core/identify/fit/problem.hpp"

namespace mpm {

/// Everything that might be wrong, each with start values. One cause appears several times where it
/// has to be looked for from several starts; equal subjects compete as one. `search_cost` holds
/// 2 ln of the number of subjects of its kind, and of the moments it may have begun at.
[[nodiscard]] std::vector<Effect> candidates(const Problem& problem,
                                             const std::vector<Effect>& accepted);

/// Disturbances whose moment or frequency shows in the innovations of a fit without them.
[[nodiscard]] std::vector<Effect> disturbance_candidates(const Problem& problem,
                                                         const CvFit& without);

/// The same cause from another moment on, around the given one, `reach` rows to either side.
[[nodiscard]] std::vector<Effect> other_onsets(const Effect& effect, Eigen::Index reach,
                                               Eigen::Index samples);

}  // namespace mpm
