#include "core/nonlinear/kernel.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/counter_noise.hpp"

namespace mpm {

TEST_CASE("kernels are what their formulas say") {
  // By hand, h = 2.
  const double x[] = {1.0, 2.0}, y[] = {-2.0, 3.0};
  const double product = 1.0 * -2.0 + 2.0 * 3.0;
  const double distance = 9.0 + 1.0;
  CHECK(Kernel{KernelKind::kGaussian, 2.0}(x, y, 2) == Approx(std::exp(-distance / 8.0)));
  CHECK(Kernel{KernelKind::kPolynomial, 2.0}(x, y, 2) ==
        Approx(std::pow(1.0 + product / 4.0, 3.0)));
  CHECK(Kernel{KernelKind::kLinearPlusGaussian, 2.0}(x, y, 2) ==
        Approx(product / 4.0 + std::exp(-distance / 8.0)));
}

TEST_CASE("the median rule takes the middle distance between different points") {
  Eigen::MatrixXd points(1, 4);
  points << 0.0, 1.0, 1.0, 5.0;  // distances 1, 1, 5, (0), 4, 4: the third of five is 4
  CHECK(median_bandwidth(points) == 4.0);
  CHECK(median_bandwidth(Eigen::MatrixXd::Zero(2, 3)) == 1.0);
}

TEST_CASE("a kernel's matrix has no negative eigenvalue") {
  Eigen::MatrixXd points(2, 30);
  for (int p = 0; p < 30; ++p) points.col(p) << test::uniform(1, p), test::uniform(2, p);
  for (const KernelKind kind :
       {KernelKind::kGaussian, KernelKind::kPolynomial, KernelKind::kLinearPlusGaussian}) {
    const Eigen::MatrixXd matrix = kernel_matrix({kind, 0.7}, points);
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues();
    CHECK(values.minCoeff() > -1e-12 * values.maxCoeff());  // rounding
  }
}

}  // namespace mpm
