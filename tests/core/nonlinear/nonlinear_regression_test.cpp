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

// Noise is a random walk with white noise on top, as much as the inputs do together, and they
// follow it slowly; the last one acts on nothing. Nominal are 0.25 of 100 channels, 2 are called
// nonlinear; more than 6 come with a chance of 0.4 %. Judged beside the terms alone it were 23, at
// p = 1e-200.
TEST_CASE("noise that wanders bends nothing", "[trials]") {
  constexpr int kInputs = 4, kSamples = 5000, kPatience = 10;
  const ModelSpec spec = test::channel_model(kInputs, 1,
                                             {{0, 0, TransferFunction{1.0, {30.0}, 0, 2, false}},
                                              {0, 1, TransferFunction{-1.0, {60.0}, 0, 5, false}},
                                              {0, 2, TransferFunction{0.7, {100.0}, 0, 1, false}}});
  const LinearModel model(spec);
  RegressionShape shape{kInputs, 1, 30, 8, {0.9672, 0.99}};
  shape.residual_poles = {0.875, 0.97};
  int called = 0;
  for (std::uint64_t seed = 400; seed < 425; ++seed) {
    MismatchDetector linear(shape, {{1.0, 0}}, kSamples, kPatience, model);
    NonlinearDetector nonlinear(
        shape, model, {NonlinearTest::kPolynomial, {1.0, 0}, kPatience, 0.01 / kInputs, 0.25});
    Eigen::VectorXd u(kInputs), e(1);
    double walk = 0.0, followed = 0.0;
    for (int k = 0; k < kSamples; ++k) {
      for (int i = 0; i < kInputs; ++i)
        u(i) = 2.0 * test::uniform(seed * 100 + static_cast<std::uint64_t>(i), k / (200 + 17 * i)) +
               (i % 2 == 1 ? 0.3 : -0.3) * followed;
      walk += 0.08 * test::uniform(seed * 100 + 50, k);
      e(0) = walk + 0.4 * test::uniform(seed * 100 + 51, k);
      followed += 0.05 * (e(0) - followed);
      linear.update(u, e);
      nonlinear.add_sample(linear);
      if (k % kPatience != kPatience - 1) continue;
      linear.fold(0);
      nonlinear.take(0, linear);
    }
    nonlinear.evaluate(0, linear);
    for (int i = 0; i < kInputs; ++i)
      called += nonlinear.result(0, i).verdict == NonlinearVerdict::kNonlinear ? 1 : 0;
  }
  CHECK(called <= 6);
}

TEST_CASE("smaller nonlinearities are said to be seen where there is less noise") {
  const auto loud = test::BentPlant{.seed = 6, .noise = 0.4}.run();
  const auto quiet = test::BentPlant{.seed = 6, .noise = 0.1}.run();
  CHECK(quiet[0].smallest_variation < 0.5 * loud[0].smallest_variation);
}

}  // namespace mpm
