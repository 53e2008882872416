#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/loop/closed_loop.hpp"

namespace mpm::sim {

/// Draws what `setup.scenario.draw` hides, from the seed's own stream: `count` different MV-CV
/// channels, each with one value of the lists, uniformly among those that the controller can stand
/// together with `setup.changes`: smallest real part of the eigenvalues of K_plant pinv(K_model) at
/// least 0.2, and a short noise-free run that settles. Nothing if too few are left.
[[nodiscard]] std::optional<std::vector<ChannelChange>> draw_changes(const LoopSetup& setup);

/// The noise-free loop moves the set-points one CV after the other and comes to rest: over the last
/// quarter of the rest the control errors stay below 5 % of the set-point steps (or twice what is
/// left with an exact model).
[[nodiscard]] bool settles(const LoopSetup& setup);

}  // namespace mpm::sim
