#include "core/identify/fit/horizons.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/diagnosis/validation.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

TEST_CASE("horizons are one sample and parts of the settling time") {
  const ModelSpec model = test::model_of({test::lag(0, 0, 2.0, 10.0)}, 1, 1);
  CHECK(horizons_of(model, 900) == std::vector<Index>{1, 15, 30, 60});
  CHECK(horizons_of(model, 25) == std::vector<Index>{1, 15, 25});
}

// A level is known after one sample; of white noise of variance s^2 two samples differ by 2 s^2, of
// a random walk those h apart by h.
TEST_CASE("a prediction that knows the last error feels neither levels nor slow wandering") {
  constexpr Index kRows = 20000;
  CHECK(squared_prediction_errors(VectorXd::Constant(50, 7.0), 10).sum() == 0.0);
  const VectorXd white = test::white(1, kRows);
  CHECK(mean_of_finite(squared_prediction_errors(white, 30)) == Approx(2.0).epsilon(0.05));
  VectorXd walk = white;
  for (Index k = 1; k < kRows; ++k) walk(k) += walk(k - 1);
  CHECK(mean_of_finite(squared_prediction_errors(walk, 4)) == Approx(4.0).epsilon(0.1));
}

TEST_CASE("an error that is not known is no error") {
  VectorXd residual = VectorXd::Zero(10);
  residual(4) = std::nan("");
  const VectorXd errors = squared_prediction_errors(residual, 3);
  REQUIRE(errors.size() == 7);
  CHECK(std::isnan(errors(1)));
  CHECK(std::isnan(errors(4)));
  CHECK(errors(0) == 0.0);
}

}  // namespace
}  // namespace mpm
