#pragma once

#include "sim/loop/closed_loop.hpp"

namespace mpm::sim {

/// The model of another unit file with its signals in the order of `plant`, as the controller of
/// that plant needs it. Throws std::invalid_argument where a signal or the sample time differs.
[[nodiscard]] ModelSpec match_signals(const config::UnitConfig& controller,
                                      const config::UnitConfig& plant);

/// Fills in `setup.changes` (named ones and what the draw adds) and the limits from its scenario.
/// Throws std::invalid_argument with the reason where the scenario does not fit the unit, or where
/// an offset-free controller could not hold such a plant and the scenario does not allow that.
void hide_changes(LoopSetup& setup);

}  // namespace mpm::sim
