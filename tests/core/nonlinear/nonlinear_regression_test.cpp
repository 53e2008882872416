#include "core/nonlinear/nonlinear_regression.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <catch2/catch.hpp>

#include "core/nonlinear/calibration.hpp"
#include "tests/core/nonlinear/bent_plant.hpp"

namespace mpm {

TEST_CASE("a nonlinearity that is just seen has the power that is said") {
  // The four columns of an input's curve, one of six groups, of an input among three: level 0.01 /
  // 9 / 6.
  const boost::math::chi_squared null(4.0);
  const double threshold = boost::math::quantile(boost::math::complement(null, 0.01 / 54.0));
  const double seen = calibration::nonlinear_test::kSeenDeviations;
  const boost::math::non_central_chi_squared there(4.0, seen * seen);
  const double power = boost::math::cdf(boost::math::complement(there, threshold));
  CHECK(power > 0.94);
  CHECK(power < 0.95);
}

TEST_CASE("a bent input is found in its channel, as what it is") {
  const NonlinearTest test =
      GENERATE(NonlinearTest::kPolynomial, NonlinearTest::kKernel, NonlinearTest::kRandomFeatures);
  test::BentPlant plant{.seed = 1, .square = 0.1, .test = test};
  const auto results = plant.run();
  CAPTURE(to_string(results[0].kind), results[0].p_value, results[1].p_value);
  CHECK(results[0].p_value < 1e-9);
  CHECK(results[0].material);
  CHECK(results[0].kind == NonlinearKind::kInputCurve);
  CHECK(results[0].share > results[1].share);
  CHECK(results[1].p_value > 1e-6);
}

TEST_CASE("a product of inputs is found in both, a linear error in none") {
  const auto product = test::BentPlant{.seed = 2, .product = 0.3}.run();
  CHECK(product[0].p_value < 1e-9);
  CHECK(product[1].p_value < 1e-9);
  CHECK(product[0].kind == NonlinearKind::kInteraction);
  for (std::uint64_t seed = 3; seed < 6; ++seed) {
    const auto linear = test::BentPlant{.seed = seed, .gain_error = 0.5}.run();
    CAPTURE(seed, linear[0].p_value, linear[1].p_value);
    CHECK_FALSE((linear[0].p_value < 0.001 && linear[0].material));  // chance: 1 in 1000
    CHECK_FALSE((linear[1].p_value < 0.001 && linear[1].material));
  }
}

TEST_CASE("p-values of a linear plant come as often as they say, right or wrong", "[trials]") {
  // 160 p-values, two from a run: more than 8 below 0.01 come once in 10 000 were the rate 0.015.
  int below = 0;
  for (std::uint64_t seed = 100; seed < 180; ++seed)
    for (const ChannelNonlinearity& result :
         test::BentPlant{.seed = seed, .gain_error = seed % 2 == 0 ? 0.0 : 0.2}.run())
      below += result.p_value < 0.01 ? 1 : 0;
  CHECK(below <= 9);
}

TEST_CASE("smaller nonlinearities are said to be seen where there is less noise") {
  const auto loud = test::BentPlant{.seed = 6, .noise = 0.4}.run();
  const auto quiet = test::BentPlant{.seed = 6, .noise = 0.1}.run();
  CHECK(quiet[0].smallest_variation < 0.5 * loud[0].smallest_variation);
}

}  // namespace mpm
