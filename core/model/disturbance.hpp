#pragma once

#include "core/model/model_spec.hpp"

namespace mpm {

/// Throws std::invalid_argument where a parameter makes no sense.
void check_disturbance(const DisturbanceTerm& disturbance);

/// What the disturbance adds to its CV at `time_s`. A time short of the onset or the end by less
/// than `tolerance_s` counts as that: sampling instants carry rounding.
[[nodiscard]] double disturbance_at(const DisturbanceTerm& disturbance, double time_s,
                                    double tolerance_s);

}  // namespace mpm
