#include "core/identify/fit/misfit_slope.hpp"

#include <catch2/catch.hpp>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The misfit by its definition, of a CV whose simulation has `added` to it.
double misfit(const test::KnownCv& cv, const VectorXd& added) {
  const VectorXd residual = (cv.fit.residual - added).cwiseProduct(cv.data.known);
  double sum = 0.0;
  for (Index k = 0; k < residual.size(); ++k) {
    double white = residual(k);
    for (Index l = 1; l <= cv.fit.noise.coefficients.size() && l <= k; ++l)
      white -= cv.fit.noise.coefficients(l - 1) * residual(k - l);
    sum += cv.data.weights(k) * white * white;
  }
  return sum / cv.fit.variance;
}

// The misfit is a parabola in each row, so that a difference over any width is its slope.
TEST_CASE("the slope is half of what the misfit falls by per unit in each row") {
  test::KnownCv cv = test::known_cv(test::white(1, 40), Eigen::Vector3d(0.7, -0.2, 0.1));
  cv.data.known(12) = cv.fit.residual(12) = 0.0;
  cv.data.weights(12) = 0.0;
  for (Index k = 20; k < 30; ++k) cv.data.weights(k) = 0.1 * static_cast<double>(k);
  cv.fit.innovations = cv.fit.noise.apply(cv.fit.residual);
  const VectorXd slope = misfit_slope(cv.data, cv.fit);
  REQUIRE(slope.size() == 40);
  for (Index k = 0; k < 40; ++k) {
    CAPTURE(k);
    const VectorXd unit = VectorXd::Unit(40, k);
    const double fall = 0.5 * (misfit(cv, -unit) - misfit(cv, unit));
    CHECK(slope(k) == Approx(0.5 * fall).margin(1e-10));
  }
  CHECK(slope(12) == 0.0);
}

TEST_CASE("without a noise model the slope is the weighted residual") {
  const test::KnownCv cv = test::known_cv(test::white(2, 30), VectorXd());
  CHECK(misfit_slope(cv.data, cv.fit).isApprox(cv.fit.residual / cv.fit.variance, 1e-14));
}

}  // namespace
}  // namespace mpm
