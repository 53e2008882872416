#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

#include "core/identify/evidence/free_run_residuals.hpp"
#include "core/identify/fit/problem.hpp"
#include "core/identify/search/search.hpp"

namespace mpm {

/// Whether a channel (CV, input) may be corrected a little where a channel of that CV was found
/// wrong (or not, the third); empty = all.
using OpenChannels = std::function<bool(int, int, bool)>;

/// The problem's model with what was found: the effects, and for each CV that they touch the small
/// channel errors and the level that were fitted beside them. A CV with `keep` false stays as it
/// was but for the effects themselves, and so does a channel that is not `open`: its small errors
/// are what noise and feedback make of a right one. Only effects with `in` true take part. As at
/// row `at`: what begins later has not begun.
[[nodiscard]] ModelSpec extend(const Problem& problem, const SearchResult& found,
                               const std::vector<bool>& in, const std::vector<bool>& keep,
                               const OpenChannels& open = {},
                               Eigen::Index at = std::numeric_limits<Eigen::Index>::max());

/// The same model at another sample time, with what was found by the problem's.
[[nodiscard]] ModelSpec extend(ModelSpec model, const Problem& problem, const SearchResult& found,
                               const std::vector<bool>& in, const std::vector<bool>& keep,
                               const OpenChannels& open = {},
                               Eigen::Index at = std::numeric_limits<Eigen::Index>::max());

/// The same from row 0 on, and from each row on where one of the effects begins.
[[nodiscard]] std::vector<Stage> stages_of(const Problem& problem, const SearchResult& found,
                                           const std::vector<bool>& in,
                                           const std::vector<bool>& keep,
                                           const OpenChannels& open = {});

/// `extended` without the aux inputs that no channel uses; `used` lists the others, which become
/// inputs after those of `base`.
[[nodiscard]] ModelSpec finish(const ModelSpec& extended, const ModelSpec& base,
                               std::vector<int>& used);

}  // namespace mpm
