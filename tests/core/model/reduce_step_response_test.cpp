#include "core/model/reduce_step_response.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

namespace mpm {
namespace {

/// Samples of a response in continuous time, which is what a held input gives at the samples.
StepResponse sampled(const std::function<double(double)>& response, int count, double sample_s,
                     double dead_time_s) {
  StepResponse result;
  for (int k = 0; k < count; ++k) {
    const double t = k * sample_s - dead_time_s;
    result.values.push_back(t > 0.0 ? response(t) : 0.0);
  }
  return result;
}

TransferFunction reduced(const StepResponse& response, double sample_s) {
  const std::optional<ReducedStepResponse> result = reduce_step_response(response, sample_s);
  REQUIRE(result);
  CHECK(result->deviation < 2e-3);
  return result->dynamics;
}

}  // namespace

// 4.05 e^{-27 s} / (50 s + 1), sampled every 4 s: 27 is no multiple of that.
TEST_CASE("a lag and its dead time come out of their step response") {
  const TransferFunction tf = reduced(
      sampled([](double t) { return 4.05 * (1.0 - std::exp(-t / 50.0)); }, 120, 4.0, 27.0), 4.0);
  REQUIRE(tf.time_constants_s.size() == 1);
  CHECK(tf.gain == Approx(4.05).epsilon(1e-3));
  CHECK(tf.time_constants_s[0] == Approx(50.0).epsilon(1e-3));
  CHECK(tf.dead_time_s == Approx(27.0).margin(0.05));
  CHECK(tf.lead_s == 0.0);
  CHECK_FALSE(tf.integrating);
}

// y = -2 (1 - (60 e^{-t/60} - 15 e^{-t/15}) / 45), dead time 10 s.
TEST_CASE("two lags come out of their step response, the slower one first") {
  const TransferFunction tf = reduced(
      sampled(
          [](double t) {
            return -2.0 * (1.0 - (60.0 * std::exp(-t / 60.0) - 15.0 * std::exp(-t / 15.0)) / 45.0);
          },
          100, 5.0, 10.0),
      5.0);
  REQUIRE(tf.time_constants_s.size() == 2);
  CHECK(tf.gain == Approx(-2.0).epsilon(1e-3));
  CHECK(tf.time_constants_s[0] == Approx(60.0).epsilon(0.01));
  CHECK(tf.time_constants_s[1] == Approx(15.0).epsilon(0.02));
  CHECK(tf.dead_time_s == Approx(10.0).margin(0.1));
}

// 3 (-8 s + 1) / ((20 s + 1) (6 s + 1)): first the wrong way. Partial fractions of
// 3 (-8 s + 1) / (s (20 s + 1) (6 s + 1)): 3 (1 - 28 / 14 e^{-t/20} + 14 / 14 e^{-t/6}).
TEST_CASE("an inverse response comes out as a negative lead") {
  const TransferFunction tf = reduced(
      sampled([](double t) { return 3.0 * (1.0 - 2.0 * std::exp(-t / 20.0) + std::exp(-t / 6.0)); },
              150, 1.0, 3.0),
      1.0);
  REQUIRE(tf.time_constants_s.size() == 2);
  CHECK(tf.gain == Approx(3.0).epsilon(1e-3));
  CHECK(tf.lead_s == Approx(-8.0).epsilon(0.01));
  CHECK(tf.time_constants_s[0] == Approx(20.0).epsilon(0.01));
  CHECK(tf.time_constants_s[1] == Approx(6.0).epsilon(0.02));
  CHECK(tf.dead_time_s == Approx(3.0).margin(0.05));
}

// 0.02 (t - 12 (1 - e^{-t/12})), dead time 4 s.
TEST_CASE("a ramp comes out as an integrator, its gain per second") {
  const TransferFunction tf =
      reduced(sampled([](double t) { return 0.02 * (t - 12.0 * (1.0 - std::exp(-t / 12.0))); }, 80,
                      2.0, 4.0),
              2.0);
  CHECK(tf.integrating);
  CHECK(tf.gain == Approx(0.02).epsilon(2e-3));
  REQUIRE(tf.time_constants_s.size() == 1);
  CHECK(tf.time_constants_s[0] == Approx(12.0).epsilon(0.01));
  CHECK(tf.dead_time_s == Approx(4.0).margin(0.05));
}

TEST_CASE("a gain with a dead time needs no time constant") {
  const TransferFunction tf = reduced({{0.0, 0.0, 0.0, 0.5, 0.5, 0.5, 0.5}}, 10.0);
  CHECK(tf.time_constants_s.empty());
  CHECK(tf.gain == 0.5);
  CHECK(tf.dead_time_s > 10.0);  // any up to two samples shows the same
  CHECK(tf.dead_time_s <= 20.0);
}

TEST_CASE("what has no such form is not forced into one") {
  // Damping 0.2: overshoots by half.
  const auto swinging = [](double t) {
    const double damped = std::sqrt(1.0 - 0.04);
    return 1.0 - std::exp(-0.2 * t / 8.0) *
                     (std::cos(damped * t / 8.0) + 0.2 / damped * std::sin(damped * t / 8.0));
  };
  CHECK_FALSE(reduce_step_response(sampled(swinging, 300, 1.0, 0.0), 1.0));
  // Cut off at 1.5 time constants: it would hold 78 % for ever.
  const auto cut = [](double t) { return 1.0 - std::exp(-t / 40.0); };
  CHECK_FALSE(reduce_step_response(sampled(cut, 61, 1.0, 0.0), 1.0));
  CHECK_FALSE(reduce_step_response({{0.0, 0.0, 0.0}}, 1.0));
  CHECK_FALSE(reduce_step_response({{0.0, 0.4, 1.0}}, 1.0));
}

}  // namespace mpm
