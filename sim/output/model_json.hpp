#pragma once

#include <nlohmann/json_fwd.hpp>

#include "config/scenario_config.hpp"

namespace mpm::sim {

/// What is hidden in a plant, in the keys of the scenario file.
[[nodiscard]] nlohmann::ordered_json hidden_plant_json(const config::HiddenPlant& hidden,
                                                       const config::UnitConfig& unit);

}  // namespace mpm::sim
