#pragma once

#include <optional>
#include <vector>

#include "core/model/model_spec.hpp"

namespace mpm {

/// The part of a model in channels that these CVs (ascending) are.
[[nodiscard]] ModelSpec of_cvs(const ModelSpec& model, const std::vector<int>& cvs);

/// The part that these CVs are at a sample time `cycle` (> 1) times as long: channels in samples,
/// and a state space, as step responses. Nothing where one of these integrates or does not settle.
[[nodiscard]] std::optional<ModelSpec> at_longer_sample_time(const ModelSpec& model,
                                                             const std::vector<int>& cvs,
                                                             double cycle);

}  // namespace mpm
