#pragma once

#include <cstddef>

#include "core/identify/fit/problem.hpp"

namespace mpm {

/// 2 ln by which the data speak for one effect of a fit on one CV if what disturbs that CV wanders
/// like a random walk under noise, whatever it was fitted with: of the CV's steps from row to row,
/// of which an autoregression is fitted with and without the effect, its size set anew. A jump
/// stands out of the steps; a drift or a slow cycle has to be more than such a walk makes by
/// itself. At least 0; search costs are not in it.
[[nodiscard]] double evidence_on_walk(Problem& problem, const Fit& fit, std::size_t effect);

/// Whether the effect is a function of time alone, or what has no name (an answer that swings with
/// time, ...), and its CV wanders beside it all the same: any walk can be cut into such. False of
/// any other effect.
[[nodiscard]] bool cuts_a_walk(const Problem& problem, const Fit& fit, std::size_t effect);

/// The most that the data can speak for such an effect, 2 ln: what they do on a walk less what its
/// numbers cost there (Laplace: each the log of what the data add to its prior's information, which
/// is about the evidence where its size is a usual one), and as much more as they speak against the
/// walk. Infinite of any other effect.
[[nodiscard]] double most_evidence(Problem& problem, const Fit& fit, std::size_t effect);

}  // namespace mpm
