#pragma once

#include <functional>
#include <vector>

#include "core/identify/fit/problem.hpp"
#include "core/identify/search/search.hpp"

namespace mpm {

/// Whether a channel (CV, input) may be corrected a little where a channel of that CV was found
/// wrong (or not, the third); empty = all.
using OpenChannels = std::function<bool(int, int, bool)>;

/// The problem's model with what was found: the effects, and for each CV that they touch the small
/// channel errors and the level that were fitted beside them. A CV with `keep` false stays as it
/// was but for the effects themselves, and so does a channel that is not `open`: its small errors
/// are what noise and feedback make of a right one. Only effects with `in` true take part.
[[nodiscard]] ModelSpec extend(const Problem& problem, const SearchResult& found,
                               const std::vector<bool>& in, const std::vector<bool>& keep,
                               const OpenChannels& open = {});

/// `extended` without the aux inputs that no channel uses; `used` lists the others, which become
/// inputs after those of `base`.
[[nodiscard]] ModelSpec finish(const ModelSpec& extended, const ModelSpec& base,
                               std::vector<int>& used);

}  // namespace mpm
