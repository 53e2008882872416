#pragma once

#include <memory>

#include "core/identify/search/search.hpp"

namespace mpm {

/// A problem and what the search found in it.
struct Explained {
  std::unique_ptr<Problem> problem;
  SearchResult found;
};

/// Searches with a free noise model. Such a model can swallow structure: where what is left is far
/// smoother than noise (and not a channel beside a disturbance that wanders), or where nothing is
/// found and the gains are not known either, a bounded one is tried too, and the one whose repair
/// carries over from the first three quarters of the data to the last decides. `recording` must
/// outlive the result.
[[nodiscard]] Explained explain(const ModelSpec& model, int model_inputs,
                                const Recording& recording, const SearchSettings& settings);

}  // namespace mpm
