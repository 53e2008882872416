#pragma once

#include <Eigen/Core>

namespace mpm {

enum class KernelKind {
  kGaussian,            ///< exp(-|x - y|^2 / 2 h^2)
  kPolynomial,          ///< (1 + x'y / h^2)^3
  kLinearPlusGaussian,  ///< x'y / h^2 + exp(-|x - y|^2 / 2 h^2)
};

/// A kernel of two points (Scholkopf and Smola 2002, section 2.3). `bandwidth` h > 0, in the
/// points' units.
struct Kernel {
  KernelKind kind = KernelKind::kGaussian;
  double bandwidth = 1.0;

  template <class Archive>
  void archive(Archive& a) {
    // not archived: kind (construction)
    a(bandwidth);
  }

  [[nodiscard]] double operator()(const double* x, const double* y, int dimension) const;
};

/// The median rule: the median distance between two of the points (dimension x count, standardised;
/// count >= 2), in which equal ones do not count; 1 where all are equal. O(count^2); allocates.
[[nodiscard]] double median_bandwidth(const Eigen::Ref<const Eigen::MatrixXd>& points);

/// Of all points with each other, count x count.
[[nodiscard]] Eigen::MatrixXd kernel_matrix(const Kernel& kernel,
                                            const Eigen::Ref<const Eigen::MatrixXd>& points);

}  // namespace mpm
