#include "core/mismatch/slow_noise.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

/// What a regression finds of A(1) in rows of e(k) = p e(k-1) + w(k), beside a constant and slow
/// waves: the mean of many.
double found(double pole, int rows, int columns, int runs) {
  double sum = 0.0;
  for (int run = 0; run < runs; ++run) {
    const Eigen::VectorXd noise =
        test::autoregressive(test::white(static_cast<std::uint64_t>(run), 2 * rows), pole)
            .tail(rows + 1);
    Eigen::MatrixXd x(rows, columns + 1);
    x.col(0) = noise.head(rows);
    for (int c = 0; c < columns; ++c)
      for (int k = 0; k < rows; ++k) x(k, 1 + c) = std::cos(M_PI * c * (k + 0.5) / rows);
    sum += 1.0 - Eigen::VectorXd(x.householderQr().solve(noise.tail(rows)))(0);
  }
  return sum / runs;
}

// By simulation; the means are known to 3 %, and the formula is none of the third order.
TEST_CASE("slow columns make slow noise look smaller than it is") {
  const struct {
    double pole;
    int rows, columns;
  } cases[] = {{0.97, 600, 5}, {0.98, 3000, 17}, {0.95, 2000, 10}, {0.9, 600, 5}};
  for (const auto& one : cases) {
    CAPTURE(one.pole, one.rows, one.columns);
    const double own = found(one.pole, one.rows, one.columns, 200);
    CHECK(own > 1.15 * (1.0 - one.pole));
    CHECK(slow_noise_ratio(own, one.columns, one.rows) ==
          Approx(own / (1.0 - one.pole)).epsilon(0.16));
  }
}

TEST_CASE("of noise that is quicker than the rows are few nothing changes, of a walk much") {
  CHECK(slow_noise_ratio(1.0, 10.0, 10'000.0) == Approx(1.0).epsilon(0.01));
  CHECK(slow_noise_ratio(0.001, 10.0, 1000.0) == 3.0);
  CHECK(slow_noise_ratio(0.0, 10.0, 1000.0) == 3.0);
  CHECK(slow_noise_ratio(-0.1, 10.0, 1000.0) == 3.0);
}

}  // namespace
}  // namespace mpm
