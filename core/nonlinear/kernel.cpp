#include "core/nonlinear/kernel.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace mpm {

double Kernel::operator()(const double* x, const double* y, int dimension) const {
  double product = 0.0, distance = 0.0;
  for (int d = 0; d < dimension; ++d) {
    product += x[d] * y[d];
    distance += (x[d] - y[d]) * (x[d] - y[d]);
  }
  const double square = bandwidth * bandwidth;
  if (kind == KernelKind::kPolynomial) {
    const double base = 1.0 + product / square;
    return base * base * base;
  }
  const double gaussian = std::exp(-0.5 * distance / square);
  return kind == KernelKind::kGaussian ? gaussian : product / square + gaussian;
}

double median_bandwidth(const Eigen::Ref<const Eigen::MatrixXd>& points) {
  std::vector<double> distances;
  for (Eigen::Index a = 0; a < points.cols(); ++a)
    for (Eigen::Index b = a + 1; b < points.cols(); ++b)
      if (const double square = (points.col(a) - points.col(b)).squaredNorm(); square > 0.0)
        distances.push_back(square);
  if (distances.empty()) return 1.0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return std::sqrt(*middle);
}

Eigen::MatrixXd kernel_matrix(const Kernel& kernel,
                              const Eigen::Ref<const Eigen::MatrixXd>& points) {
  const Eigen::Index count = points.cols();
  const Eigen::MatrixXd dense = points;
  Eigen::MatrixXd matrix(count, count);
  for (Eigen::Index a = 0; a < count; ++a)
    for (Eigen::Index b = a; b < count; ++b)
      matrix(a, b) = matrix(b, a) =
          kernel(dense.col(a).data(), dense.col(b).data(), static_cast<int>(dense.rows()));
  return matrix;
}

}  // namespace mpm
