#include "core/identify/evidence/free_run_residuals.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::free_run_residuals_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kRows = 400;

TEST_CASE("what a right model leaves is the noise, and a clipped value leaves nothing") {
  const VectorXd u = test::telegraph(1, kRows, 12), noise = 0.1 * test::white(2, kRows);
  VectorXd y = test::first_order(u, 2.0, 10.0) + noise;
  y(7) = std::nan("");
  const ModelSpec model = test::model_of({test::lag(0, 0, 2.0, 10.0)}, 1, 1);
  const MatrixXd residuals = free_run_residuals(model, test::recording_of(u, y));
  CHECK(std::isnan(residuals(7, 0)));
  CHECK((residuals - noise).bottomRows(kRows - 100).cwiseAbs().maxCoeff() < 0.01);

  const double limit = 1.2;
  const VectorXd clipped = y.cwiseMin(limit);
  const MatrixXd left = free_run_residuals(model, test::recording_of(u, clipped));
  Index clips = 0;
  for (Index k = 0; k < kRows; ++k)
    if (y(k) >= limit) {
      ++clips;
      CHECK(std::isnan(left(k, 0)));
    }
  CHECK(clips > 10);
}

// A sensor of which the span is 1.3 times as wide from a row on.
TEST_CASE("what a plant that changed leaves is the noise before and behind it") {
  constexpr Index kChanged = 200;
  const VectorXd u = test::telegraph(1, kRows, 12), noise = 0.1 * test::white(2, kRows);
  VectorXd y = test::first_order(u, 2.0, 10.0);
  y.tail(kRows - kChanged) *= 1.3;
  const std::vector<Stage> stages = {
      {0, test::model_of({test::lag(0, 0, 2.0, 10.0)}, 1, 1)},
      {kChanged, test::model_of({test::lag(0, 0, 2.6, 10.0)}, 1, 1)}};
  const MatrixXd residuals = free_run_residuals(stages, test::recording_of(u, y + noise));
  CHECK((residuals - noise).bottomRows(kRows - 100).cwiseAbs().maxCoeff() < 0.01);
}

}  // namespace
}  // namespace mpm::free_run_residuals_test
