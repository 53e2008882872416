#pragma once

#include <vector>

namespace mpm::causes {

/// Dead time errors (samples) to begin a fit from: a misfit is blind to dead times far from its
/// own.
[[nodiscard]] std::vector<double> dead_time_starts(double removable_samples);

}  // namespace mpm::causes
