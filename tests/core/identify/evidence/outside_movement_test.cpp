#include "core/identify/evidence/outside_movement.hpp"

#include <catch2/catch.hpp>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::outside_movement_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kRows = 4000;

struct Loop {
  MatrixXd u, y, residuals;
};

/// y(k) = 0.9 y(k-1) + 0.1 u(k-1) + noise, u(k) = -gain y(k) + outside(k); the model's gain is
/// `model_gain` times the plant's.
Loop closed_loop(double gain, double outside_sd, double model_gain) {
  const VectorXd noise = 0.1 * test::white(1, kRows), outside = outside_sd * test::white(2, kRows);
  Loop loop{MatrixXd::Zero(kRows, 1), MatrixXd::Zero(kRows, 1), MatrixXd::Zero(kRows, 1)};
  double y = 0.0, u = 0.0, simulated = 0.0;
  for (Index k = 0; k < kRows; ++k) {
    y = 0.9 * y + 0.1 * u + noise(k);
    simulated = 0.9 * simulated + 0.1 * model_gain * u;
    u = -gain * y + outside(k);
    loop.u(k, 0) = u;
    loop.y(k, 0) = y;
    loop.residuals(k, 0) = y - simulated;
  }
  return loop;
}

double share(const Loop& loop) {
  return outside_shares(test::recording_of(loop.u, loop.y), loop.residuals)[0].value();
}

TEST_CASE("an input that nothing feeds back moves from outside") {
  CHECK(share(closed_loop(0.0, 1.0, 1.0)) > 0.98);
  CHECK(share(closed_loop(0.0, 1.0, 0.5)) > 0.98);  // however wrong the model
}

TEST_CASE("an input that only a controller moves does not") {
  CHECK(share(closed_loop(2.0, 0.0, 1.0)) < 0.02);
  CHECK(share(closed_loop(2.0, 0.0, 0.5)) < 0.02);
}

// With the loop closed y = (0.1 outside + noise) / (1 - 0.7 q^-1), so of u = -2 y + outside the
// noise makes 4 0.01 / (1 - 0.49) = 0.0784; the outside part has the impulse response 1, -0.2,
// -0.14, ...: s^2 (1 + 0.04 / 0.51) = 1.0784 s^2. For s^2 = 0.0727 that is as much.
TEST_CASE("where both move it the share is that of the variances") {
  const double s = std::sqrt(0.0784 / 1.0784);
  CHECK(share(closed_loop(2.0, s, 1.0)) == Approx(0.5).margin(0.06));
  CHECK(share(closed_loop(2.0, s, 0.7)) == Approx(0.5).margin(0.06));
}

TEST_CASE("an input that stands still has no share") {
  const Loop loop = closed_loop(0.0, 0.0, 1.0);
  CHECK_FALSE(outside_shares(test::recording_of(loop.u, loop.y), loop.residuals)[0].has_value());
}

}  // namespace
}  // namespace mpm::outside_movement_test
