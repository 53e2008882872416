#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// Measured minus free run on all rows, samples x CVs; NaN where a CV is unknown or clips. `model`
/// in channels, with the recording's aux signals as inputs.
[[nodiscard]] Eigen::MatrixXd free_run_residuals(const ModelSpec& model,
                                                 const Recording& recording);

/// What a plant is from a row on.
struct Stage {
  Eigen::Index first = 0;
  ModelSpec model;
};

/// The same of a plant that changed: from each stage's first row on what its model, as if it had
/// always been so, says (as `Problem::simulate`). `stages`: in time, the first from row 0 on.
[[nodiscard]] Eigen::MatrixXd free_run_residuals(const std::vector<Stage>& stages,
                                                 const Recording& recording);

}  // namespace mpm
