#pragma once

#include <vector>

#include "core/identify/causes/finding.hpp"
#include "core/identify/diagnosis/account.hpp"
#include "core/identify/diagnosis/unseen.hpp"
#include "core/identify/search/search.hpp"

namespace mpm {

/// CVs of which something was refused and of which alone nothing is named: what is named of all CVs
/// of an input may have left anything of theirs.
[[nodiscard]] std::vector<int> without_a_name(const Account& kept, const ModelSpec& model);

/// Disturbances of some CVs that had passed before the unseen samples, found beside the extended
/// model, on the rows that were fitted. Where something was refused, what had been named beside it
/// went too; but what has passed stands on its own evidence, which has to be strong, for no unseen
/// sample judges it. `model`, with aux inputs, is the extended one; `fitted` must be of its inputs.
/// What else disturbs the CVs is looked for too, so that nothing passes for it, and not told.
[[nodiscard]] std::vector<Finding> find_passed(const ModelSpec& model, int model_inputs,
                                               const Recording& fitted, const std::vector<int>& cvs,
                                               Unseen& unseen, const SearchSettings& settings);

}  // namespace mpm
