#include "core/identify/fit/noise_before.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/evidence/channel_tests.hpp"
#include "core/identify/evidence/free_run_residuals.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::noise_before_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 3000;

ModelSpec model() { return test::model_of({lag(0, 0, 1.0, 5.0), lag(1, 1, 1.0, 5.0)}, 2, 2); }

/// The plant is the model. What disturbs the first CV reaches the second 15 s later; of the second
/// input the controller makes the least of the first CV, as one of several CVs may.
Recording in_a_loop(std::uint64_t seed) {
  const VectorXd load = test::autoregressive(0.2 * test::normal(seed, kRows), 0.9);
  const VectorXd own = test::autoregressive(0.1 * test::normal(seed + 1, kRows), 0.5);
  const double pole = std::exp(-1.0 / 5.0);
  MatrixXd u = MatrixXd::Zero(kRows, 2), y = MatrixXd::Zero(kRows, 2);
  Eigen::Vector2d x = Eigen::Vector2d::Zero();
  u.col(0) = test::telegraph(seed + 2, kRows, 20);
  const VectorXd test_signal = 0.3 * test::telegraph(seed + 3, kRows, 12);
  double passed = 0.0;  // what of the load has reached the second CV
  const double slow = std::exp(-1.0 / 15.0);
  for (Index k = 0; k < kRows; ++k) {
    y.row(k) << x(0) + load(k), x(1) + 2.0 * passed + own(k);
    u(k, 1) = test_signal(k) - 0.8 * (y(k, 0) - x(0));
    for (int i = 0; i < 2; ++i) x(i) = pole * x(i) + (1.0 - pole) * u(k, i);
    passed = slow * passed + (1.0 - slow) * load(k);
  }
  return test::recording_of(u, y);
}

/// Of the second CV's only channel, beside nothing but that.
struct Gain {
  double ratio = 0.0, sd = 0.0;
};
Gain fitted_gain(const Recording& recording) {
  Problem problem(model(), 2, recording, Tolerances{}, NoiseModel{});
  const Coordinate gain{&kGainRatio, 1.0, 1.0, 0.5, 0.01, 0.02, 20.0};
  const Fit fit = problem.fit({{&causes::gain(), {1, 1}, {gain}}}, 0, {1});
  return {fit.effects[0].coordinates[0].value, std::sqrt(fit.covariance(0, 0))};
}

TEST_CASE("what goes before is the last innovation and means of them, in each run") {
  // Expected: what the residual was made of, but for what some 500 rows tell of its pole.
  const VectorXd white = test::normal(5, 600);
  VectorXd residual(600), known = VectorXd::Ones(600);
  residual << test::autoregressive(white.head(200), 0.8),
      test::autoregressive(white.tail(400), 0.8);
  residual(500) = known(500) = 0.0;
  const MatrixXd before = noise_before(residual, known, {{0, 200}, {200, 400}}, {.order = 1});
  double mean = 0.0;
  for (Index k = 0; k < 600; ++k) {
    const bool first = k == 0 || k == 200;
    // Of the rows without a past, or of whose past nobody knows, nothing is known.
    const bool without = first || k == 1 || k == 201 || k == 501 || k == 502;
    const double last = without ? 0.0 : std::clamp(white(k - 1), -3.0, 3.0);
    CHECK(before(k, 0) == Approx(last).margin(0.3));
    mean = first ? 0.0 : 0.6 * mean + 0.4 * before(k, 0);
    CHECK(before(k, 1) == Approx(mean).margin(1e-12));
  }
}

TEST_CASE("a level that shifts does not go before as noise does") {
  // Expected: of a shift by 20 s.d. no more than the three of its first row.
  VectorXd residual = 0.1 * test::normal(6, 600);
  residual.tail(300).array() += 2.0;
  const MatrixXd before = noise_before(residual, VectorXd::Ones(600), {{0, 600}}, {.order = 8});
  CHECK(before.col(3).cwiseAbs().maxCoeff() < 0.1);
}

TEST_CASE("under feedback a gain is right beside the noise that goes before, and wrong without") {
  // Expected: 1, as the plant has it.
  for (std::uint64_t seed = 100; seed < 600; seed += 100) {
    CAPTURE(seed);
    Recording recording = in_a_loop(seed);
    const Gain alone = fitted_gain(recording);
    CHECK(std::abs(alone.ratio - 1.0) > 5.0 * alone.sd);
    recording.noise_before = {{}, {0}};
    const Gain beside = fitted_gain(recording);
    CHECK(std::abs(beside.ratio - 1.0) < 4.0 * beside.sd);
    CHECK(beside.sd < 0.1);
  }
}

TEST_CASE("the regression of a recording tells whose noise goes before") {
  // Expected: as it was made.
  for (std::uint64_t seed = 100; seed < 600; seed += 100) {
    const Recording recording = in_a_loop(seed);
    const ChannelTests tests(model(), recording, free_run_residuals(model(), recording));
    CHECK(tests.noise_before(0).empty());
    CHECK(tests.noise_before(1) == std::vector<int>{0});
  }
}

}  // namespace
}  // namespace mpm::noise_before_test
