#pragma once

#include "core/identify/causes/finding.hpp"
#include "core/identify/search/search.hpp"

/// What was found, in the terms of the contract.
namespace mpm {

/// A difference that is there but that no cause explains: shown and located, not named.
struct Unexplained {
  Subject subject;       ///< how it seems to come about: an unnamed cause; the input it goes with
  double p_value = 1.0;  ///< of what is left having nothing to do with it
  double share = 0.0;    ///< of the residual's variance that it makes up
};

/// A fitted number as reports give it, in its form, with an interval of `reach` to either side that
/// ends where the number may go no further, or at 0.
[[nodiscard]] Parameter stated(const Coordinate& coordinate, double reach, double sample_time_s);

/// The cause named at `index`.
[[nodiscard]] Finding to_finding(const SearchResult& found, std::size_t index,
                                 const Problem& problem);

/// What was seen at `index` and has no name: how likely by chance, and how much of the residual it
/// makes up.
[[nodiscard]] Unexplained to_unexplained(const SearchResult& found, std::size_t index,
                                         Problem& problem);

}  // namespace mpm
