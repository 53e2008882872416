#include "core/identification/restricted_noise.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::test::restricted_noise_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index kRows = 300;

/// Slow columns, which take slow noise away: sines of 1 to 6 half periods.
MatrixXd slow_columns() {
  MatrixXd columns(kRows, 6);
  for (Index k = 0; k < kRows; ++k)
    for (Index c = 0; c < columns.cols(); ++c)
      columns(k, c) = std::sin(std::acos(-1.0) * static_cast<double>((c + 1) * k) / kRows);
  return columns;
}

VectorXd behind_filter(const VectorXd& x, double a) {
  VectorXd white = x;
  white.tail(x.size() - 1) -= a * x.head(x.size() - 1);
  white(0) = 0.0;
  return white;
}

MatrixXd behind_filter(const MatrixXd& x, double a) {
  MatrixXd white = x;
  for (Index c = 0; c < x.cols(); ++c) white.col(c) = behind_filter(VectorXd(x.col(c)), a);
  return white;
}

}  // namespace

TEST_CASE("restricted likelihood takes back what fitted columns took from slow noise") {
  // Noise of pole 0.95 with six slow columns fitted to it: plain least squares is off by some
  // hundredths on average of forty draws (each +- 0.02), restricted likelihood is not.
  const double pole = 0.95;
  double plain = 0.0, restricted = 0.0;
  const int draws = 40;
  for (int draw = 0; draw < draws; ++draw) {
    VectorXd noise = white(900 + static_cast<std::uint64_t>(draw), kRows + 200);
    for (Index k = 1; k < noise.size(); ++k) noise(k) += pole * noise(k - 1);
    const VectorXd values = noise.tail(kRows);
    const MatrixXd columns = slow_columns();
    Whitening found;
    found.coefficients = VectorXd::Constant(1, 0.9);
    VectorXd weights = VectorXd::Ones(kRows);
    weights(0) = 0.0;
    double last = 0.0;
    for (const bool take_back : {false, true}) {
      for (int turn = 0; turn < 20; ++turn) {
        const double a = found.coefficients(0);
        const MatrixXd whitened = behind_filter(columns, a);
        const VectorXd residual =
            values - columns * Eigen::ColPivHouseholderQR<MatrixXd>(whitened).solve(
                                   behind_filter(values, a));
        found = fit_whitening(residual, weights, {1, 0.0});
        if (!take_back) continue;
        const double variance =
            behind_filter(residual, found.coefficients(0)).squaredNorm() / (kRows - 7);
        FittedColumns fitted;
        fitted.own = MatrixXd(kRows, 0);
        fitted.own_white = MatrixXd(kRows, 0);
        fitted.shared = columns;
        fitted.shared_white = behind_filter(columns, found.coefficients(0));
        found = restricted_noise({fitted}, residual, weights, found, variance);
      }
      (take_back ? restricted : plain) += found.coefficients(0) / draws;
      last = found.coefficients(0);
    }
    CHECK(std::isfinite(last));
  }
  // What is left is the bias of any autoregression of 300 rows, (1 + 3 a) / rows = 0.013.
  CAPTURE(plain);
  CHECK(plain < pole - 0.04);
  CHECK(restricted == Approx(pole - 0.013).margin(0.015));
}

}  // namespace mpm::test::restricted_noise_test
