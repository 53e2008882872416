#pragma once

#include <Eigen/Core>

namespace mpm {

/// An autoregressive noise model: r(k) = sum a_l r(k-l) + white. A(q) = 1 - sum a_l q^-l.
struct Whitening {
  Eigen::VectorXd coefficients;  ///< a_1 .. a_p

  /// A(q) x; the first p rows, which lack a past, are zero.
  [[nodiscard]] Eigen::VectorXd apply(const Eigen::Ref<const Eigen::VectorXd>& x) const;
};

/// Weighted least squares of r on its own past (orthogonal, scaled columns); rows of weight zero
/// take no part. p = `order`.
[[nodiscard]] Whitening fit_whitening(const Eigen::Ref<const Eigen::VectorXd>& residual,
                                      const Eigen::Ref<const Eigen::VectorXd>& weights, int order);

}  // namespace mpm
