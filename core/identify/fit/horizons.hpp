#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/model/model_spec.hpp"

namespace mpm {

/// How well a model predicts so many samples ahead as a controller would: the simulation, shifted
/// by what it is off now (output-bias update; Shook, Mohtadi and Shah 1992 judge models so). What
/// wanders slowly does not count, nor does what feedback made of it.
struct Horizon {
  Eigen::Index samples = 0;
  double rmse_before = 0.0, rmse_after = 0.0;  ///< CV units
};

/// One sample, half, one and two settling times of a model in channels, in samples, ascending; what
/// is longer than `longest` is `longest`.
[[nodiscard]] std::vector<Eigen::Index> horizons_of(const ModelSpec& model, Eigen::Index longest);

/// Squared prediction errors at a horizon, one per row from which it can be predicted; NaN where
/// unknown. `residual`: measured minus simulated.
[[nodiscard]] Eigen::VectorXd squared_prediction_errors(
    const Eigen::Ref<const Eigen::VectorXd>& residual, Eigen::Index horizon);

}  // namespace mpm
