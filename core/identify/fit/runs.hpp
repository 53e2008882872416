#pragma once

#include <Eigen/Core>

#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// Intervals without a row that a simulation may be carried across, its inputs held: one slowest
/// time constant of the model, at least 20. After a longer gap more than half of what a CV does
/// comes from inputs that nobody knows, so that a new run is the better start.
[[nodiscard]] Eigen::Index longest_gap(const ModelSpec& model);

/// Rows with a CV for which an input may be unknown and is taken as unchanged: 20.
[[nodiscard]] Eigen::Index longest_loss();

/// `recording` without the rows in which an input was lost: unknown for longer (longest_loss()).
/// What it did meanwhile nobody knows, so a new run begins after them. An input of which more than
/// half of the rows would go is read seldom, not lost.
[[nodiscard]] Recording without_lost_inputs(Recording recording);

/// `recording` without the runs, where there are several, of less than 40 rows: such a one tells no
/// more than its own level and first state.
[[nodiscard]] Recording without_scraps(const Recording& recording);

}  // namespace mpm
