#pragma once

#include <memory>

#include "core/identify/search/search.hpp"

namespace mpm {

/// A free noise model with as long a past as the residual of some CV that wanders asks for (Akaike
/// 1974): a disturbance that wanders and is measured with noise remembers longer than a few
/// samples, and under feedback what the noise model forgets is laid to the channels. Of what comes
/// back a long past would take structure for noise.
[[nodiscard]] NoiseModel free_noise(const ModelSpec& model, int model_inputs,
                                    const Recording& recording);

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
