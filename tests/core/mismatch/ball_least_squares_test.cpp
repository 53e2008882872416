#include "core/mismatch/ball_least_squares.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/allocation_counter.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm {
namespace {

constexpr int kSize = 6;

TEST_CASE("least squares in a ball: of a round one, what is left of the length") {
  BallLeastSquares ball(kSize);
  const Eigen::MatrixXd m = Eigen::MatrixXd::Identity(kSize, kSize);
  Eigen::VectorXd c = Eigen::VectorXd::Zero(kSize);
  c << 3.0, 0.0, 4.0, 0.0, 0.0, 0.0;
  const Eigen::Ref<const Eigen::VectorXd> part = c.head(kSize);
  const std::uint64_t before = test::allocation_count();
  const double left = ball.distance_square(m, part, 2.0);
  CHECK(test::allocation_count() == before);
  CHECK(left == Approx(9.0));
  CHECK(ball.distance_square(m, c, 5.5) == 0.0);
  CHECK(ball.distance_square(m, c, 0.0) == 25.0);
}

TEST_CASE("least squares in a ball: as far as projected gradients come, flat directions or not") {
  BallLeastSquares ball(kSize);
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    Eigen::MatrixXd m(kSize, kSize);
    Eigen::VectorXd c(kSize);
    int draw = 0;
    for (int i = 0; i < kSize; ++i) {
      c(i) = 3.0 * test::uniform(700 + trial, draw++);
      for (int j = 0; j < kSize; ++j) m(i, j) = test::uniform(700 + trial, draw++);
    }
    if (trial % 3 == 0) m.col(2).setZero();
    if (trial % 4 == 0) m.col(4) = 1e-3 * m.col(1);
    const double radius = 0.2 + 0.2 * static_cast<double>(trial);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(kSize);
    const double step = 1.0 / m.squaredNorm();
    for (int turn = 0; turn < 20000; ++turn) {
      x += step * (m.transpose() * (c - m * x));
      if (x.norm() > radius) x *= radius / x.norm();
    }
    const double reached = (c - m * x).squaredNorm();
    const double found = ball.distance_square(m, c, radius);
    CAPTURE(trial);
    CHECK(found <= reached * (1.0 + 1e-9) + 1e-12);
    CHECK(found >= reached - 0.02 * reached - 1e-6);
  }
}

}  // namespace
}  // namespace mpm
