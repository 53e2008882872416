#pragma once

#include <Eigen/Core>

#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// Measured minus free run on all rows, samples x CVs; NaN where a CV is unknown or clips. `model`
/// in channels, with the recording's aux signals as inputs.
[[nodiscard]] Eigen::MatrixXd free_run_residuals(const ModelSpec& model,
                                                 const Recording& recording);

}  // namespace mpm
