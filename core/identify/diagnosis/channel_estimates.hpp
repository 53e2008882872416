#pragma once

#include <vector>

#include "core/identify/causes/finding.hpp"
#include "core/identify/search/search.hpp"

namespace mpm {

/// How far a channel of the plant is from the model's, with everything else refitted.
struct ChannelEstimate {
  int cv = 0;
  int input = 0;
  Parameter gain_ratio, time_constant_ratio, dead_time_error;  ///< the last in s
};

/// Each channel of the model by itself, everything else as found.
[[nodiscard]] std::vector<ChannelEstimate> estimate_channels(Problem& problem,
                                                             const SearchResult& found,
                                                             const SearchSettings& settings);

/// How many gains the data do not tell, so that a match would mean nothing.
[[nodiscard]] std::ptrdiff_t unknown_gains(const std::vector<ChannelEstimate>& estimates);

/// Whether some gain is off by more than is small, surely (95 %), or at least that much and off
/// beyond doubt: a model that is said to match would be contradicted by its own estimates.
[[nodiscard]] bool has_gain_off(const std::vector<ChannelEstimate>& estimates);

}  // namespace mpm
