#pragma once

#include "config/scenario_config.hpp"

namespace mpm::sim {

/// The unit's model with what the scenario hides in the plant. Blocks and channels stand in place
/// of the model's own. Where an aux signal acts, all of them are inputs behind the DVs.
[[nodiscard]] ModelSpec plant_model(const config::UnitConfig& unit,
                                    const config::HiddenPlant& hidden);

}  // namespace mpm::sim
