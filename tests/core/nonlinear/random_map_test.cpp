#include "core/nonlinear/random_map.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "core/nonlinear/kernel.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm {
namespace {

// Largest error of the products of features against the kernel, over pairs of 20 points.
double largest_error(int frequencies) {
  Eigen::MatrixXd points(2, 20);
  for (int p = 0; p < 20; ++p) points.col(p) << test::uniform(1, p), test::uniform(2, p);
  RandomMap map(2, frequencies, 7);
  map.begin(points);
  const Eigen::MatrixXd wanted =
      kernel_matrix({KernelKind::kGaussian, median_bandwidth(points)}, points);
  Eigen::MatrixXd features(map.outputs(), 20);
  for (int p = 0; p < 20; ++p) {
    const Eigen::Vector2d point = points.col(p);
    map.apply(point.data(), features.col(p).data());
  }
  return (features.transpose() * features - wanted).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("products of random features are the Gaussian kernel, the nearer the more there are") {
  // One pair's error has an s.d. of at most sqrt(1 / 2 D); five of them at the worst of 190 pairs.
  for (const int frequencies : {50, 800, 12800})
    CHECK(largest_error(frequencies) < 5.0 * std::sqrt(0.5 / frequencies));
  CHECK(largest_error(12800) < largest_error(50));
}

TEST_CASE("random features are the same each time, and none before they begin") {
  CHECK(largest_error(5) == largest_error(5));
  RandomMap map(1, 2, 7);
  Eigen::VectorXd features = Eigen::VectorXd::Ones(4);
  const double point = 0.4;
  map.apply(&point, features.data());
  CHECK(features.isZero());
  CHECK_THROWS_AS(RandomMap(1, 0, 7), std::invalid_argument);
}

}  // namespace mpm
