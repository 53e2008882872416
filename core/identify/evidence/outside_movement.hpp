#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/identify/fit/recording.hpp"

namespace mpm {

/// Per input the share, 0..1, of its movement that comes from outside the loop (set-points,
/// measured disturbances, operators, test signals) and not from a controller that answers the CVs'
/// disturbances. Nothing where an input stands still or the rows do not suffice.
///
/// From the joint autoregression of the model's residuals and the inputs, residuals first in every
/// interval: the inputs are what the innovations of the residuals make of them, plus what their own
/// innovations do (variance decomposition, Sims 1980). That is so whatever the model's errors: what
/// an input does to a residual is no innovation of the residual.
/// `residuals`: samples x CVs, NaN where unknown.
[[nodiscard]] std::vector<std::optional<double>> outside_shares(const Recording& recording,
                                                                const Eigen::MatrixXd& residuals);

}  // namespace mpm
