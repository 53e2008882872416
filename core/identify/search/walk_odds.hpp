#pragma once

#include <cstddef>
#include <optional>

#include "core/identify/fit/problem.hpp"

namespace mpm {

/// 2 ln by which a CV of a fit speaks for one of its effects if what disturbs the CV wanders like a
/// random walk under noise, whatever it was fitted with: of the CV's steps from row to row, of
/// which an autoregression is fitted with and without what the effect adds to them, its size set
/// anew. A jump, and what answers inputs that move, stands out of the steps; a drift, a slow cycle
/// or what answers a slow input has to be more than such a walk makes by itself (between two walks
/// a regression always finds something: Granger and Newbold 1974). At least 0; search costs are not
/// in it. Null where the effect adds nothing to the CV.
[[nodiscard]] std::optional<double> evidence_on_walk(Problem& problem, const Fit& fit,
                                                     std::size_t effect, const CvFit& state);

/// The most that the odds for an effect can be, 2 ln: what the data say for it on a walk less what
/// its numbers cost there (Laplace: each the log of what the data add to its prior's information,
/// which is about the evidence where its size is a usual one) and its search and rarity, and as
/// much more as they speak against the walk; of all CVs of the fit. Infinite where it adds to none.
[[nodiscard]] double most_odds(Problem& problem, const Fit& fit, std::size_t effect);

/// Whether an effect is a function of time alone, or what has no name (an answer that swings with
/// time, ...): any walk can be cut into such.
[[nodiscard]] bool is_of_time(const Effect& effect);

/// Whether the effect is such, and its CV wanders beside it all the same.
[[nodiscard]] bool cuts_a_walk(const Problem& problem, const Fit& fit, std::size_t effect);

}  // namespace mpm
