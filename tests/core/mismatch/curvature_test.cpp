#include "core/mismatch/curvature.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "core/mismatch/mismatch_detector.hpp"
#include "tests/core/channel_model.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::curvature_test {
namespace {

constexpr int kSamples = 2000;

ModelSpec two_channels() {
  return test::channel_model(2, 1,
                             {{0, 0, TransferFunction{2.0, {15.0}, 0, 2, false}},
                              {0, 1, TransferFunction{-1.0, {8.0}, 0, 0, false}}});
}

// Both inputs move about `level` (the model's operating point is 0). The plant gives the model's
// g_0 + g_1, plus `bend` g_0^2, plus `gain_error` g_0 from sample `from` on, plus noise.
struct Plant {
  std::uint64_t seed;
  double bend = 0.0, gain_error = 0.0;
  int from = 0;
  double level = 0.0;

  [[nodiscard]] MismatchDetector run() const {
    const ModelSpec spec = two_channels();
    const LinearModel whole(spec);
    MismatchDetector detector({2, 1, 12, 4, {std::exp(-1.0 / 15.0)}}, {{1.0, 0}}, 2400, 10, whole);
    LinearModel first = whole.channel(0, 0);
    Eigen::VectorXd u(2), e(1), only(1);
    double noise = 0.0;
    for (int k = 0; k < kSamples; ++k) {
      for (int i = 0; i < 2; ++i)
        u(i) = level + 2.0 * test::uniform(seed * 10 + static_cast<std::uint64_t>(i), k / 20);
      noise = 0.8 * noise + 0.1 * test::uniform(seed * 10 + 5, k);
      const double g = first.output()(0);
      e(0) = noise + bend * g * g + (k >= from ? gain_error * g : 0.0);
      detector.update(u, e);
      only(0) = u(0);
      first.advance(only);
    }
    detector.fold(0);
    return detector;
  }
};

// e = c g^2: the local gain is 1 + 2 c g, so it varies by two s.d. of 2 c g. g is a first-order lag
// (T 15) of gain 2 on levels of variance 4/3 that last 20: computed from the same numbers.
double true_variation(const Plant& plant) {
  LinearModel first = LinearModel(two_channels()).channel(0, 0);
  double sum = 0.0, square = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    const double g = first.output()(0);
    sum += g;
    square += g * g;
    first.advance(Eigen::VectorXd::Constant(1, 2.0 * test::uniform(plant.seed * 10, k / 20)));
  }
  const double sd = std::sqrt(square / kSamples - std::pow(sum / kSamples, 2));
  return 2.0 * 2.0 * plant.bend * sd;
}

}  // namespace

TEST_CASE("an answer that bends is found, with how much its gain varies") {
  const Plant plant{.seed = 1, .bend = 0.05};
  MismatchDetector detector = plant.run();
  REQUIRE(detector.take_in_curvature(0, 0.0));
  const Curvature& found = *detector.curvature(0);
  CHECK(found.channels[0].gain_variation == Approx(true_variation(plant)).epsilon(0.1));
  CHECK(found.channels[0].sure_variation > 0.5 * true_variation(plant));
  CHECK(found.channels[0].p_value < 1e-9);
  CHECK(found.channels[1].p_value > 1e-6);
  CHECK(found.channels[1].gain_variation < 0.2 * found.channels[0].gain_variation);
  CHECK(found.channels[1].sure_variation == 0.0);
}

// The bound is 99 %: of 40 more than 4 exceed the truth, or zero of the channel that does not bend,
// with a probability of 1e-4 (binomial). Of a run the s.d. of the ratio is a fifth or so, of the
// mean of twenty 0.05.
TEST_CASE("of a gain's variation no more is sure than there is") {
  int beyond = 0, of_the_other = 0, runs = 0;
  double ratio = 0.0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Plant plant{.seed = seed, .bend = 0.02};
    MismatchDetector detector = plant.run();
    if (!detector.take_in_curvature(0, 0.0)) continue;
    ++runs;
    const Curvature& found = *detector.curvature(0);
    beyond += found.channels[0].sure_variation > true_variation(plant) ? 1 : 0;
    of_the_other += found.channels[1].sure_variation > 0.0 ? 1 : 0;
    ratio += found.channels[0].gain_variation / true_variation(plant);
  }
  CAPTURE(runs, ratio / runs);
  CHECK(runs > 20);  // so small a bend is not found in each
  CHECK(beyond <= 4);
  CHECK(of_the_other <= 4);
  CHECK(ratio / runs == Approx(1.0).epsilon(0.1));
}

TEST_CASE("beside the bend the linear part is what it is") {
  // Away from the operating point a bend looks like a gain error: by 2 c g there, 0.05 * 2 * 2.
  for (const double error : {0.0, 0.2}) {
    MismatchDetector detector =
        Plant{.seed = 2, .bend = 0.05, .gain_error = error, .level = 1.0}.run();
    detector.evaluate(0);
    CHECK(detector.evidence(0, 0).p_value < 1e-9);
    REQUIRE(detector.take_in_curvature(0, 0.0));
    detector.evaluate(0);
    const ChannelEvidence& evidence = detector.evidence(0, 0);
    CAPTURE(error, evidence.gain_error.value, evidence.gain_error.deviation);
    CHECK(std::abs(evidence.gain_error.value - error) < 3.5 * evidence.gain_error.deviation);
    CHECK(evidence.gain_error.deviation < 0.05);
    CHECK((evidence.p_value < 1e-6) == (error != 0.0));
    CHECK(detector.evidence(0, 1).p_value > 1e-3);
  }
}

TEST_CASE("nothing bends where the plant is linear, right or wrong") {
  // p < 1e-9 in 40 runs: chance alone, once in 25 million.
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const double error : {0.0, 0.3}) {
      MismatchDetector detector = Plant{.seed = seed, .gain_error = error}.run();
      CAPTURE(seed, error);
      CHECK_FALSE(detector.take_in_curvature(0, 0.0));
      CHECK(detector.curvature(0) == nullptr);
    }
}

TEST_CASE("curvature has to explain more than what else was found") {
  MismatchDetector detector = Plant{.seed = 3, .bend = 0.05}.run();
  CHECK_FALSE(detector.take_in_curvature(0, 1e9));
  CHECK(detector.take_in_curvature(0, 0.0));
  CHECK_FALSE(detector.take_in_curvature(0, 0.0));  // it has it already
}

}  // namespace mpm::curvature_test
