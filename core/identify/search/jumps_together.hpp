#pragma once

#include <vector>

#include "core/identify/search/trial.hpp"

namespace mpm {

/// Of several jumps of one CV none may stand without its first row: beside the others the noise
/// looks as if it wandered, and would keep a shock. Together they leave it at rest. `jump` has its
/// size alone and stands for one at any moment; those that explain most beside the ones before are
/// looked at, and as many of the first are taken as are the most probable. Moments that stand out
/// as shocks cost no more than to pick them from all shocks that are as large. The trials have one
/// jump each, the same fit of all, and what each adds to the others; empty where they are fewer
/// than two or not decisive together, or one of them is not beside the others. Weighs the rows anew
/// (Trials::settle).
[[nodiscard]] std::vector<Trial> jumps_together(Trials& trials, const Effect& jump,
                                                double decisive);

}  // namespace mpm
