#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "tests/hidden/true_plant.hpp"

namespace mpm::hidden {

/// Measured signals that the model does not use and that wander by themselves: a first-order
/// autoregression or random steps, each with a level and s.d. of its own as a thermometer would
/// have. The plant gets their levels as operating points.
[[nodiscard]] Eigen::MatrixXd add_aux_signals(TruePlantSpec& plant, int count, int samples,
                                              std::uint64_t seed, std::uint64_t attempt);

}  // namespace mpm::hidden
