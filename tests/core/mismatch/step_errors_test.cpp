#include "core/mismatch/step_errors.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/monitor/monitor.hpp"
#include "tests/core/open_loop_unit.hpp"

namespace mpm::step_errors_test {
namespace {

/// 1 - exp(-(t - dead) / lag)
double rise(double t, double dead, double lag) {
  return t <= dead ? 0.0 : 1.0 - std::exp(-(t - dead) / lag);
}

/// By its definition, of a first-order channel that answers as another one does, both of gain 1.
double defined(double dead, double lag, double other_dead, double other_lag, int length) {
  const double end = 1.5 * std::ceil(dead + lag * std::log(20.0));
  double error = 0.0, model = 0.0;
  for (int l = 1; l < length; ++l) {
    const double weight = l <= end ? 1.0 : 0.5 * end / l;
    error += std::pow(weight * (rise(l, other_dead, other_lag) - rise(l, dead, lag)), 2);
    model += std::pow(weight * rise(l, dead, lag), 2);
  }
  return std::sqrt(error / model);
}

struct Channel {
  test::OpenLoopUnit unit;
  RegressionShape shape;
  LinearModel model;
  StepErrors steps;

  Channel() : shape(shape_of()), model(unit.model), steps(shape, model) {}

  static RegressionShape shape_of() {
    RegressionShape shape;
    shape.inputs = shape.cvs = 2;
    shape.fir_lags = 20;
    shape.residual_order = 2;
    shape.tail_poles = {std::exp(-1.0 / 15.0), std::exp(-1.0 / 3.0)};
    return shape;
  }
  [[nodiscard]] int length() const { return BlockBasis(20, shape.tail_poles).length(); }
  /// Of gain -1, dead time 1, time constant 8.
  [[nodiscard]] Eigen::VectorXd pulse() const { return model.impulse_response(0, 1, length()); }
};

ReducedErrors exactly(double gain, double time, double shift) {
  ReducedErrors reduced;
  reduced.r = 10.0 * Eigen::Matrix3d::Identity();
  reduced.c = 10.0 * Eigen::Vector3d(gain, time, shift);
  return reduced;
}

TEST_CASE("an error of the gain is as large as that of the step response") {
  const Channel channel;
  CHECK(channel.steps.of_pulse(0, 1, 0.12 * channel.pulse()) == Approx(0.12).epsilon(1e-12));
  const Estimate of_fit =
      channel.steps.of_fit(0, 1, exactly(-0.12, 0.0, 0.0), error_column::kLater, 4.0);
  CHECK(of_fit.value == Approx(0.12).epsilon(1e-9));
  // 2 / 10 of the gain, and what the time constants and the dead time add.
  CHECK(of_fit.deviation >= 0.2);
  CHECK(of_fit.deviation < 0.21);
}

TEST_CASE("an error of dead time or time constant is what it does to the step response") {
  // Expected: the definition, on the closed forms of first-order responses; lags behind the block
  // stand for those around them, which costs a little.
  const Channel channel;
  Eigen::VectorXd later = Eigen::VectorXd::Zero(channel.length());
  later.tail(channel.length() - 2) = channel.pulse().segment(1, channel.length() - 2);
  CHECK(channel.steps.of_pulse(0, 1, later - channel.pulse()) ==
        Approx(defined(1.0, 8.0, 2.0, 8.0, channel.length())).epsilon(0.02));
  CHECK(channel.steps.of_fit(0, 1, exactly(0.0, 0.0, 1.0), error_column::kLater, 1.0).value ==
        Approx(defined(1.0, 8.0, 2.0, 8.0, channel.length())).epsilon(0.02));
  CHECK(channel.steps.of_fit(0, 1, exactly(0.0, std::log(1.1), 0.0), error_column::kLater, 1.0)
            .value == Approx(defined(1.0, 8.0, 1.0, 8.8, channel.length())).epsilon(0.06));
}

ChannelStatus monitored(test::OpenLoopUnit unit, std::uint64_t seed) {
  unit.seed = seed;
  Monitor monitor(unit.model, unit.counts, {true, true}, {}, {});
  unit.run(3000, [&](const Frame& frame) { monitor.push(frame); });
  return monitor.channel(0, 1);
}

// A dead time of one sample more beside a time constant of 40 is seen beyond doubt and changes the
// response by 1 %; so do two lags for which one was fitted, by 0.6 %. Both raised alarms.
TEST_CASE("what hardly changes the step response does not matter, however surely it is there",
          "[trials]") {
  test::OpenLoopUnit late, two_lags, gain;
  late.channel().time_constants_s = {40.0};
  late.later = 1.0;
  two_lags.channel() = {-1.0, {30.75}, 0.0, 4.5, false};
  two_lags.plant = TransferFunction{-1.0, {30.0, 4.0}, 0.0, 1.0, false};
  gain = two_lags;
  gain.plant->gain = -1.2;
  int seen = 0, matters = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    const ChannelStatus shift = monitored(late, seed), order = monitored(two_lags, seed);
    CHECK(shift.p_value_material > 1e-3);
    CHECK(order.p_value_material > 1e-7);  // what an alarm takes
    seen += shift.p_value < 1e-3 ? 1 : 0;
    seen += order.p_value < 1e-3 ? 1 : 0;
    matters += monitored(gain, seed).p_value_material < 1e-5 ? 1 : 0;
  }
  CHECK(seen > 10);
  CHECK(matters >= 8);
}

// The half rule (Skogestad 2003, 2.3) makes a lag of 40 behind a dead time of 10 of lags of 30 and
// 20, whose response is off by 2.5 % at the most: its first lags are seen to be wrong beyond doubt,
// and that more than 2 % are is not known. A dead time of 4 samples more beside that lag is off by
// 3.6 %.
TEST_CASE("a model that was reduced by the half rule does not matter, a later answer does",
          "[trials]") {
  test::OpenLoopUnit half_rule, late;
  half_rule.channel() = {-1.0, {40.0}, 0.0, 10.0, false};
  half_rule.plant = TransferFunction{-1.0, {30.0, 20.0}, 0.0, 0.0, false};
  late.channel() = {-1.0, {40.0}, 0.0, 10.0, false};
  late.later = 4.0;
  int seen = 0, matters = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    const ChannelStatus order = monitored(half_rule, seed), shift = monitored(late, seed);
    CHECK(order.p_value_material > 1e-3);
    seen += order.p_value < 1e-3 ? 1 : 0;
    matters += shift.p_value_material < 1e-5 ? 1 : 0;
  }
  CHECK(seen >= 9);
  CHECK(matters >= 9);
}

}  // namespace
}  // namespace mpm::step_errors_test
