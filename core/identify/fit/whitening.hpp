#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identify/fit/recording.hpp"

namespace mpm {

/// An autoregressive noise model: r(k) = sum a_l r(k-l) + white. A(q) = 1 - sum a_l q^-l.
struct Whitening {
  Eigen::VectorXd coefficients;  ///< a_1 .. a_p
  std::vector<Border> borders;   ///< of the rows that it is applied to

  /// A(q) x; the first p rows of each run, which lack a past, are zero.
  [[nodiscard]] Eigen::VectorXd apply(const Eigen::Ref<const Eigen::VectorXd>& x) const;
};

/// How the noise of a CV is modelled.
struct NoiseModel {
  int order = 8;  ///< of the autoregression
  /// Bound of the coefficient of a first-order one; 0 = none. With a bound the fit is nearly one of
  /// output errors: for recordings whose residual is structure rather than noise, which a free
  /// noise model would swallow.
  double bound = 0.0;
};

/// Weighted least squares of r on its own past (orthogonal, scaled columns); rows of weight zero
/// take no part: the first p of each run must be such.
[[nodiscard]] Whitening fit_whitening(const Eigen::Ref<const Eigen::VectorXd>& residual,
                                      const Eigen::Ref<const Eigen::VectorXd>& weights,
                                      const NoiseModel& model);

}  // namespace mpm
