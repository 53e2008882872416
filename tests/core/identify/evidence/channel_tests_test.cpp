#include "core/identify/evidence/channel_tests.hpp"

#include <catch2/catch.hpp>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::channel_tests_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

/// Two inputs, one CV under integrating noise; the first channel's gain is `ratio` times the
/// model's.
ChannelTests tests_of(double ratio, std::uint64_t seed, Index rows) {
  MatrixXd u(rows, 2);
  u << test::telegraph(seed, rows, 12), test::telegraph(seed + 1000, rows, 9);
  const VectorXd model =
      test::first_order(u.col(0), 2.0, 10.0) + test::first_order(u.col(1), 1.0, 5.0);
  VectorXd walk = 0.1 * test::white(seed + 2000, rows);
  for (Index k = 1; k < rows; ++k) walk(k) += walk(k - 1);
  const MatrixXd y = model + (ratio - 1.0) * test::first_order(u.col(0), 2.0, 10.0) + walk;
  const MatrixXd residuals = y - model;
  const ModelSpec spec = test::model_of({lag(0, 0, 2.0, 10.0), lag(0, 1, 1.0, 5.0)}, 2, 1);
  return {spec, test::recording_of(u, y), residuals};
}

// The level of the test is 5 %: 6 or more of 40 healthy channels rejected come in 1.4 % of such
// sets, and the seeds are fixed.
TEST_CASE("a wandering disturbance is no reason to reject a channel") {
  int rejected = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const ChannelTests tests = tests_of(1.0, seed, 1500);
    for (int input = 0; input < 2; ++input) rejected += tests.reject({{0, input}}) ? 1 : 0;
  }
  CHECK(rejected < 6);
}

TEST_CASE("the wrong channel is rejected under it, and the other is not blamed") {
  const ChannelTests tests = tests_of(1.3, 3, 1500);
  CHECK(tests.p_value(0, 0).value() < 1e-6);
  CHECK(tests.reject({{0, 0}}));
  CHECK(tests.reject({{0, 0}, {0, 1}}));
  CHECK_FALSE(tests.reject({{0, 1}}));
}

TEST_CASE("an input that was not in the test has no test") {
  const ChannelTests tests = tests_of(1.3, 3, 1500);
  CHECK_FALSE(tests.p_value(0, 2).has_value());
  CHECK_FALSE(tests.reject({{0, 2}}));
}

TEST_CASE("few rows get a smaller regression, and too few none") {
  CHECK(tests_of(1.5, 5, 200).p_value(0, 0).has_value());
  const ChannelTests none = tests_of(1.5, 5, 40);
  CHECK_FALSE(none.p_value(0, 0).has_value());
  CHECK_FALSE(none.reject({{0, 0}}));
}

constexpr Index kLoopRows = 2000;

VectorXd setpoint_of(std::uint64_t seed) { return 2.0 * test::telegraph(seed, kLoopRows, 100); }

VectorXd noise_of(std::uint64_t seed) {
  return test::autoregressive(0.08 * test::normal(seed + 1, kLoopRows), 0.95);
}

ChannelTests tests_beside(const VectorXd& setpoint, const VectorXd& u, const VectorXd& residual) {
  Recording recording = test::recording_of(u, test::first_order(u, 2.0, 10.0) + residual);
  recording.setpoints = setpoint;
  return {test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1), recording, residual};
}

/// A PI loop that follows its set-point, the gain `ratio` times the model's.
ChannelTests tests_of_loop(double ratio, std::uint64_t seed) {
  const VectorXd setpoint = setpoint_of(seed), noise = noise_of(seed);
  VectorXd u = VectorXd::Zero(kLoopRows), residual = u;
  const double pole = std::exp(-0.1);
  double sum = 0.0, state = 0.0;
  for (Index k = 0; k < kLoopRows; ++k) {
    residual(k) = (ratio - 1.0) * state + noise(k);
    const double error = setpoint(k) - ratio * state - noise(k);
    sum += error;
    u(k) = 0.6 * error + 0.06 * sum;
    state = pole * state + 2.0 * (1.0 - pole) * u(k);
  }
  return tests_beside(setpoint, u, residual);
}

/// The channel is right; a set-point moves the CV, and partly the input too.
ChannelTests tests_of_hidden_path(std::uint64_t seed) {
  const VectorXd setpoint = setpoint_of(seed);
  return tests_beside(setpoint, test::telegraph(seed + 2, kLoopRows, 12) + 0.5 * setpoint,
                      test::first_order(setpoint, 1.0, 30.0) + noise_of(seed));
}

TEST_CASE("a set-point wins where it moves the CV itself, and not against a wrong channel") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    const ChannelTests wrong = tests_of_loop(1.5, seed), hidden = tests_of_hidden_path(seed);
    REQUIRE(wrong.reject({{0, 0}}));
    REQUIRE(hidden.reject({{0, 0}}));
    CHECK_FALSE(wrong.setpoint(0).wins);
    CHECK((hidden.setpoint(0).wins && !hidden.setpoint(0).loses));
    const RivalSignal sound = tests_of_loop(1.0, seed).setpoint(0);
    CHECK_FALSE((sound.wins || sound.loses));
  }
}

}  // namespace
}  // namespace mpm::channel_tests_test
