#include "core/mismatch/box_least_squares.hpp"

#include <catch2/catch.hpp>

#include "tests/core/counter_noise.hpp"

namespace mpm {
namespace {

TEST_CASE("least squares in a box: no point of a fine grid is better") {
  // Expected: exhaustive search over 41^3 points; the optimum may only be better than its best.
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    Eigen::Matrix3d r = Eigen::Matrix3d::Zero();
    Eigen::Vector3d c;
    int draw = 0;
    for (int i = 0; i < 3; ++i) {
      c(i) = 3.0 * test::uniform(900 + trial, draw++);
      for (int j = i; j < 3; ++j) r(i, j) = test::uniform(900 + trial, draw++);
    }
    if (trial % 5 == 0) r(2, 2) = 0.0;  // a direction with nothing of its own
    const Eigen::Vector3d low(-0.5, -1.0, 0.0);
    const Eigen::Vector3d high(0.5, 0.2, 2.0);
    const BoxSolution solution = box_least_squares(r, c, low, high);
    double best = 1e300;
    for (int a = 0; a <= 40; ++a)
      for (int b = 0; b <= 40; ++b)
        for (int d = 0; d <= 40; ++d) {
          const Eigen::Vector3d x = low + Eigen::Vector3d(a, b, d).cwiseProduct(high - low) / 40.0;
          best = std::min(best, (c - r * x).squaredNorm());
        }
    CAPTURE(trial);
    CHECK(solution.distance_square <= best * (1.0 + 1e-12));
    CHECK((solution.x.array() >= low.array()).all());
    CHECK((solution.x.array() <= high.array()).all());
    CHECK(solution.distance_square == Approx((c - r * solution.x).squaredNorm()));
  }
}

}  // namespace
}  // namespace mpm
