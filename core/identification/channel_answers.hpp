#pragma once

#include <optional>
#include <vector>

#include "core/identification/form_choice.hpp"
#include "core/identification/identification.hpp"

namespace mpm {

/// What is said of each channel of a CV, inputs in order: its numbers where one was fitted, or why
/// it is not in the model. `refused`: predictions are no better with the channels. Whether a
/// p-value stands among those of all CVs is not asked here.
[[nodiscard]] std::vector<ChannelAnswer> channel_answers(
    const Material& material, const HighOrderModel& model, const std::vector<ChannelHint>& hints,
    int cv, const std::optional<PredictionErrorFit>& fit, const NoiseAssumption& noise,
    bool refused);

}  // namespace mpm
