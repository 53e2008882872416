#pragma once

#include <Eigen/Core>

#include "core/identify/fit/problem.hpp"

namespace mpm {

/// Half the fall of a CV's misfit (whitened, over its variance) per unit of what is added to its
/// simulation in each row, samples long: its sum with any shape says how well that shape would
/// explain the innovations of `fit`, without whitening the shape.
[[nodiscard]] Eigen::VectorXd misfit_slope(const CvData& data, const CvFit& fit);

}  // namespace mpm
