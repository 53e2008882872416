#pragma once

#include "config/unit_config.hpp"

namespace mpm::config {

/// Set-point moves, noise and moving disturbances for a unit that says nothing of its simulation,
/// in proportion to its gains: MVs move by about half a unit, noise is some 6 % of that. Without
/// any, a simulated loop stands still, and nothing can be found in it. The model is a possible one.
void give_default_movement(UnitConfig& config);

}  // namespace mpm::config
