#pragma once

#include <Eigen/Core>

#include "core/model/linear_model.hpp"

namespace mpm::sim {

/// cv_count x input_count: what the static blocks multiply each channel with near the operating
/// point (first polynomial coefficient of the input and of the channel's own block, scale of the
/// output; 1 for all others).
[[nodiscard]] Eigen::MatrixXd static_slopes(const ModelSpec& spec);

/// Steady-state gains near the operating point, cv_count x mv_count. In the row of a CV that
/// integrates, the integrating channels' slopes per sample stand alone: nothing else lasts there.
[[nodiscard]] Eigen::MatrixXd operating_gain(const ModelSpec& spec, int mv_count);

}  // namespace mpm::sim
