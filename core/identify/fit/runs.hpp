#pragma once

#include <Eigen/Core>

#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// Intervals without a row that a simulation may be carried across, its inputs held: one slowest
/// time constant of the model, at least 20. After a longer gap more than half of what a CV does
/// comes from inputs that nobody knows, so that a new run is the better start.
[[nodiscard]] Eigen::Index longest_gap(const ModelSpec& model);

/// `recording` without the runs, where there are several, of less than 40 rows: such a one tells no
/// more than its own level and first state.
[[nodiscard]] Recording without_scraps(const Recording& recording);

}  // namespace mpm
