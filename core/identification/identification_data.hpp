#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identify/fit/recording.hpp"

namespace mpm {

/// A recording as a fit of linear models takes it.
struct IdentificationData {
  double sample_time_s = 1.0;
  Eigen::MatrixXd inputs;      ///< samples x inputs, deviations from the mean; held where unknown
  Eigen::VectorXd input_mean;  ///< own units
  Eigen::MatrixXd cvs;         ///< samples x CVs, deviations from the mean; 0 where unknown
  Eigen::VectorXd cv_mean;     ///< CV units
  Eigen::MatrixXd known;       ///< samples x CVs, 1 or 0
  std::vector<Run> runs;
  std::vector<Border> borders;

  [[nodiscard]] Eigen::Index samples() const { return cvs.rows(); }
};

[[nodiscard]] IdentificationData identification_data(const Recording& recording);

/// s.d. about the mean of the known values.
[[nodiscard]] double spread_of(const Eigen::Ref<const Eigen::VectorXd>& values,
                               const Eigen::Ref<const Eigen::VectorXd>& known);

}  // namespace mpm
