#pragma once

#include <Eigen/Core>

namespace mpm {

/// Measurements on the model's sample grid, one row per sample, NaN where a value is not known.
/// Row convention as in `Frame`: y(k) was measured, then u(k) was applied and acts until k+1.
struct Recording {
  double start_s = 0.0;        ///< of the first row, on the clock of the data
  double sample_time_s = 1.0;  ///< > 0
  Eigen::MatrixXd inputs;      ///< samples x model inputs (MVs, then DVs), own units
  Eigen::MatrixXd cvs;         ///< samples x CVs, CV units
  Eigen::MatrixXd aux;         ///< samples x measured signals that the model does not use
  /// Samples x CVs, CV units; a column of NaN for a CV without one, or no columns at all.
  Eigen::MatrixXd setpoints = {};

  [[nodiscard]] Eigen::Index samples() const { return cvs.rows(); }
};

/// The same with the set-points as measured signals behind the aux ones: what moves with a
/// set-point is no error of a channel.
[[nodiscard]] Recording with_setpoints(const Recording& recording);

/// Some rows of a recording, on the same clock.
[[nodiscard]] Recording part(const Recording& recording, Eigen::Index first, Eigen::Index count);

}  // namespace mpm
