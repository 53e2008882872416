#pragma once

#include <memory>
#include <vector>

#include "core/identify/causes/finding.hpp"
#include "core/identify/diagnosis/confirmation.hpp"
#include "core/identify/diagnosis/selection.hpp"
#include "core/identify/search/search.hpp"

namespace mpm {

/// Why the extended model does without a finding, for a person; empty where it does not.
[[nodiscard]] const char* why_not_in_model(Fate fate);

/// What the search finds, and what is left of it once nothing stands on what unseen data refuse or
/// on what may be nothing: such goes, the rest is fitted anew, and what only made sense beside it
/// goes too.
struct Account {
  std::unique_ptr<Problem> problem;
  SearchResult found;
  Selection selection;  ///< refuses nothing of it
  std::vector<Effect> refused_effects;
  std::vector<Finding> refused;  ///< the same, most important last
};

/// Searches `fitted` for what `settings` let be named; what the witness does not bear out goes too.
/// Where what they do not is suspected and the inputs move mostly from outside the loop, everything
/// is looked for, and believed if all of it takes much off the errors of predictions on unseen
/// samples: no feedback can make that up. Of what is not believed the levels are taken that the
/// rest could not tell from a walk. `fitted` must outlive the result.
[[nodiscard]] Account account_for(const ModelSpec& model, int model_inputs, const Recording& fitted,
                                  const Judges& judges, const Witness& witness,
                                  const SearchSettings& settings);

}  // namespace mpm
