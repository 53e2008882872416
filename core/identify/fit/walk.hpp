#pragma once

#include <Eigen/Core>

#include "core/identify/fit/problem.hpp"

namespace mpm {

/// The steps from row to row of what disturbs a CV, if that wanders like a random walk under noise:
/// an autoregression of the steps makes them white.
struct WalkSteps {
  Whitening noise;
  Eigen::VectorXd weights;  ///< of rows; 0 where a step or its past is not known

  /// Steps of x, whitened and weighted: rows of a least squares, not yet in s.d.
  [[nodiscard]] Eigen::VectorXd rows_of(const Eigen::Ref<const Eigen::VectorXd>& x) const;
  /// How many rows have a weight.
  [[nodiscard]] double rows() const;
};

/// Of a CV that is off by `wander` (0 where unknown).
[[nodiscard]] WalkSteps walk_steps(const CvData& data, const CvFit& fit,
                                   const Eigen::Ref<const Eigen::VectorXd>& wander);

/// What `left_of` leaves beside first states and small errors of the channels as they would be if
/// that were a random walk: set by its steps alone, for what is fitted to a level follows any walk,
/// and makes it come back.
/// (Schmidt and Phillips 1992 set a trend so.)
[[nodiscard]] Eigen::VectorXd left_beside_a_walk(const CvData& data, const CvFit& fit);

}  // namespace mpm
