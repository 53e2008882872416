#pragma once

#include <string>

#include "sim/loop/closed_loop.hpp"
#include "sim/output/bad_data.hpp"

namespace mpm::sim {

/// What a run hides, as JSON: scenario, seed, every changed channel (plant against model), noise,
/// disturbances, set-points, what became of the controller, and the determinants of the gains that
/// the controller believes in and that the plant has in the end (null where there are not as many
/// CVs as MVs).
/// `filter` adds what it has done to the reported data so far.
[[nodiscard]] std::string truth_json(const LoopSetup& setup, const std::string& controller_file,
                                     const BadDataFilter* filter = nullptr);

}  // namespace mpm::sim
