#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identify/fit/whitening.hpp"

namespace mpm {

/// What was fitted to the rows of one run beside the noise, plain and whitened.
struct FittedColumns {
  Eigen::MatrixXd own;           ///< rows x columns of this run alone: level, first state
  Eigen::MatrixXd own_white;     ///< below the rows those of a prior
  Eigen::MatrixXd shared;        ///< rows x columns that all runs share: slopes of the channels
  Eigen::MatrixXd shared_white;  ///< rows x columns
};

/// The autoregression of most restricted likelihood (Patterson and Thompson 1971): what was fitted
/// takes most from slow noise, of which little is left in the residual, so that plain least squares
/// finds it too quick and its level too low. The normal equations gain what the log determinant of
/// the fitted columns' information changes by with each coefficient. `noise`, `variance`: those of
/// plain least squares, on the same rows.
[[nodiscard]] Whitening restricted_noise(const std::vector<FittedColumns>& runs,
                                         const Eigen::Ref<const Eigen::VectorXd>& residual,
                                         const Eigen::Ref<const Eigen::VectorXd>& weights,
                                         const Whitening& noise, double variance);

}  // namespace mpm
