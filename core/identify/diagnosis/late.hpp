#pragma once

#include <vector>

#include "core/identify/causes/finding.hpp"
#include "core/identify/search/search.hpp"

namespace mpm {

/// What begins in the rows that were kept to measure repairs on, from `first` on. No search of the
/// rows before can find it, and a verdict that knows nothing of it would be of the past. `model`,
/// with aux inputs, is the extended one; only effects with an onset there are looked for, and only
/// where a CV's residual is larger there than before, and which `settings.may_name`. None of them
/// is repaired: no rows are left that could judge it.
[[nodiscard]] std::vector<Finding> find_late(const ModelSpec& model, int model_inputs,
                                             const Recording& recording, Eigen::Index first,
                                             const SearchSettings& settings);

/// The row from which on an effect counts as late, a little before `first`.
[[nodiscard]] Eigen::Index late_from(Eigen::Index first);

}  // namespace mpm
