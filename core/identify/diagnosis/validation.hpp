#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/identify/fit/horizons.hpp"

namespace mpm {

/// One CV's free-running simulation on the samples that no fit has seen.
struct CvScore {
  double rmse_before = 0.0, rmse_after = 0.0;  ///< CV units
  double fit_before = 0.0, fit_after = 0.0;    ///< 100 (1 - |y - ysim| / |y - mean y|)
  double level_after = 0.0;                    ///< mean of y - ysim, CV units
  /// 95 % block-bootstrap interval of 1 - rmse_after / rmse_before.
  double gain_low = 0.0, gain_high = 0.0;
  bool refused = false;  ///< an extension was fitted and did not carry over
  std::vector<Horizon> horizons;
  bool judged = true;  ///< false: read too seldom to be judged beside the others
};

/// Of the values that are; 1 where there are none or all are 0.
[[nodiscard]] double mean_of_finite(const Eigen::Ref<const Eigen::VectorXd>& values);

/// Root of the mean of those that are finite; 0 where there are none.
[[nodiscard]] double rms_of_squares(const Eigen::Ref<const Eigen::VectorXd>& squares);

/// One CV's scores on the rows given: `before` and `after` are free-running simulations; rows with
/// an unknown measurement take no part. The interval of the gain is a moving-block bootstrap of the
/// squared errors (Kuensch 1989), blocks of `block` rows, drawn from `seed`.
[[nodiscard]] CvScore score(const Eigen::Ref<const Eigen::VectorXd>& measured,
                            const Eigen::Ref<const Eigen::VectorXd>& before,
                            const Eigen::Ref<const Eigen::VectorXd>& after, Eigen::Index block,
                            std::uint64_t seed);

/// The same from squared errors; fits and levels stay 0.
[[nodiscard]] CvScore score_errors(const Eigen::Ref<const Eigen::VectorXd>& before,
                                   const Eigen::Ref<const Eigen::VectorXd>& after,
                                   Eigen::Index block, std::uint64_t seed);

}  // namespace mpm
