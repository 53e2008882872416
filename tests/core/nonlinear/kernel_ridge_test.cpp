#include "core/nonlinear/kernel_ridge.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "core/nonlinear/kernel.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::kernel_ridge_test {
namespace {

struct Data {
  Eigen::MatrixXd points, nuisance, kernel;
  Eigen::VectorXd response;

  // y = slope x + square x^2 + noise, x uniform.
  Data(int count, std::uint64_t seed, double slope, double square) : points(1, count) {
    nuisance.resize(count, 2);
    response.resize(count);
    for (int k = 0; k < count; ++k) {
      const double x = 1.7 * test::uniform(2 * seed, k);
      points(0, k) = x;
      nuisance.row(k) << 1.0, x;
      response(k) = slope * x + square * x * x + test::uniform(2 * seed + 1, k);
    }
    kernel = kernel_matrix({KernelKind::kGaussian, median_bandwidth(points)}, points);
  }
  [[nodiscard]] KernelFit fit() const { return fit_kernel(kernel, nuisance, response); }
};

}  // namespace

TEST_CASE("the fit is the ridge regression's closed form for the ridge that was chosen") {
  const Data data(60, 1, 2.0, 1.0);
  const KernelFit fit = data.fit();
  const Eigen::Index count = 60;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(count, count);
  const Eigen::MatrixXd q = one - data.nuisance *
                                      (data.nuisance.transpose() * data.nuisance).inverse() *
                                      data.nuisance.transpose();
  const Eigen::MatrixXd k = q * data.kernel * q;
  const Eigen::MatrixXd hat = k * (k + fit.ridge * one).inverse();
  CHECK((hat * q * data.response - fit.fitted).norm() < 1e-8 * fit.fitted.norm());
  CHECK(fit.freedom == Approx(hat.trace()).epsilon(1e-8));
  const Eigen::VectorXd y = q * data.response;
  CHECK(fit.correlation == Approx(y.dot(fit.fitted) / (y.norm() * fit.fitted.norm())));
  // No ridge ten times as large or as small has a smaller GCV.
  const auto gcv = [&](double ridge) {
    const Eigen::MatrixXd h = k * (k + ridge * one).inverse();
    return (y - h * y).squaredNorm() / std::pow(count - 2 - h.trace(), 2);
  };
  CHECK(gcv(fit.ridge) <= gcv(10.0 * fit.ridge));
  CHECK(gcv(fit.ridge) <= gcv(0.1 * fit.ridge));
}

TEST_CASE("a kernel sees a square that no slope shows, and a slope says nothing to it") {
  const KernelFit square = Data(150, 2, 0.0, 1.0).fit();
  CHECK(square.p_value < 1e-6);
  CHECK(square.correlation > 0.5);
  const KernelFit slope = Data(150, 3, 100.0, 0.0).fit();
  CHECK(slope.p_value > 1e-3);
}

TEST_CASE("p-values of the score statistic come as often as they say, as those of permutations") {
  // 600 sets: a share below 0.05 (0.01) beyond four s.d., 0.0089 (0.0041), comes once in 16 000.
  // The same by its rank among circular shifts of the response, which are a null by themselves:
  // points are independent.
  int below_5 = 0, below_1 = 0;
  double disagreement = 0.0;
  for (std::uint64_t set = 0; set < 600; ++set) {
    const Data data(40, 1000 + set, 1.0, 0.0);
    const double p_value = data.fit().p_value;
    below_5 += p_value < 0.05 ? 1 : 0;
    below_1 += p_value < 0.01 ? 1 : 0;
    if (set % 30 != 0) continue;
    int as_small = 0;
    for (int shift = 1; shift < 40; ++shift) {
      Data moved = data;
      for (Eigen::Index k = 0; k < 40; ++k) moved.response(k) = data.response((k + shift) % 40);
      as_small += moved.fit().p_value <= p_value ? 1 : 0;
    }
    disagreement += std::abs((as_small + 1) / 40.0 - p_value) / 20.0;
  }
  CHECK(below_5 > 600 * (0.05 - 4 * 0.0089));
  CHECK(below_5 < 600 * (0.05 + 4 * 0.0089));
  CHECK(below_1 < 600 * (0.01 + 4 * 0.0041));
  CHECK(disagreement < 0.12);  // 39 shifts know p to sqrt(p (1 - p) / 39), 0.06 on average
}

TEST_CASE("shapes that do not fit are refused") {
  const Data data(20, 4, 1.0, 0.0);
  CHECK_THROWS_AS(fit_kernel(data.kernel, data.nuisance.topRows(10), data.response),
                  std::invalid_argument);
  CHECK_THROWS_AS(fit_kernel(data.kernel, Eigen::MatrixXd::Identity(20, 20), data.response),
                  std::invalid_argument);
}

}  // namespace mpm::kernel_ridge_test
