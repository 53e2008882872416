#include "core/identify/fit/channel_edit.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

#include "core/model/linear_model.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using test::lag;

ChannelSpec filter(std::vector<double> numerator, std::vector<double> denominator, int delay) {
  return {0, 0, DiscreteFilter{std::move(numerator), std::move(denominator), delay}, {}};
}

ChannelSpec response(std::vector<double> values) {
  return {0, 0, StepResponse{std::move(values)}, {}};
}

ChannelSpec tanks() { return {0, 0, TankChain{{20.0, 35.0}, -1.0, -2.0, {}, 0.0, 6.0}, {}}; }

template <class Dynamics>
Dynamics edited_as(const ChannelSpec& channel, const ChannelError& error,
                   double sample_time_s = 1.0) {
  return std::get<Dynamics>(edited(channel, error, sample_time_s).dynamics);
}

double steady_gain(const DiscreteFilter& filter) {
  double above = 0.0, below = 0.0;
  for (const double value : filter.numerator) above += value;
  for (const double value : filter.denominator) below += value;
  return above / below;
}

// By hand: each number is the model's times or plus the error.
TEST_CASE("an edited transfer function keeps its form") {
  const ChannelSpec channel{0, 0, TransferFunction{2.0, {10.0, 30.0}, 4.0, 5.0, false}, {}};
  const auto wrong = edited_as<TransferFunction>(channel, {1.5, 2.0, -1.25});
  CHECK(wrong.gain == Approx(3.0));
  CHECK(wrong.time_constants_s == std::vector<double>{20.0, 60.0});
  CHECK(wrong.lead_s == Approx(8.0));
  CHECK(wrong.dead_time_s == Approx(3.75));
  CHECK(edited_as<TransferFunction>(channel, {1.0, 1.0, -7.0}).dead_time_s == 0.0);
}

TEST_CASE("edited tanks move their time constants and dead time, never their gain") {
  const auto wrong = edited_as<TankChain>(tanks(), {1.5, 0.5, -7.0});
  CHECK(wrong.time_constants_s == std::vector<double>{10.0, 17.5});
  CHECK(wrong.dead_time_s == 0.0);
  CHECK(wrong.empty_input == -1.0);
  CHECK(wrong.empty_output == -2.0);
}

// A lag e^{-t/T} sampled once a second has the pole e^{-1/T}: T r times as long is the r-th root.
TEST_CASE("a filter's real poles move to the root that the time constants' ratio says") {
  const double ratio = 2.5;
  const std::vector<double> poles = {0.8, 0.3};
  const double scale = 3.0;  // of the whole fraction, which has to stay
  const ChannelSpec channel =
      filter({0.2 * scale, 0.1 * scale},
             {scale, -scale * (poles[0] + poles[1]), scale * poles[0] * poles[1]}, 2);
  const auto wrong = edited_as<DiscreteFilter>(channel, {1.0, ratio, 0.0});
  const double p = std::pow(poles[0], 1.0 / ratio), q = std::pow(poles[1], 1.0 / ratio);
  REQUIRE(wrong.denominator.size() == 3);
  CHECK(wrong.denominator[0] == Approx(scale));
  CHECK(wrong.denominator[1] == Approx(-scale * (p + q)).epsilon(1e-12));
  CHECK(wrong.denominator[2] == Approx(scale * p * q).epsilon(1e-12));
  CHECK(wrong.delay_samples == 2);
  const double gain = 0.3 / ((1.0 - poles[0]) * (1.0 - poles[1]));
  CHECK(steady_gain(wrong) == Approx(gain).epsilon(1e-12));
  CHECK(wrong.numerator[0] / wrong.numerator[1] == Approx(2.0).epsilon(1e-12));
  const auto larger = edited_as<DiscreteFilter>(channel, {1.3, ratio, 0.0});
  CHECK(steady_gain(larger) == Approx(1.3 * gain).epsilon(1e-12));
}

// A pair r e^{+-i w}: z^2 - 2 r cos(w) z + r^2. log z = log r + i w; damping is in its real part.
TEST_CASE("a filter's complex pair keeps its frequency where only the damping moves") {
  const double r = 0.9, w = 0.4;
  const ChannelSpec channel = filter({0.5}, {1.0, -2.0 * r * std::cos(w), r * r}, 0);
  const auto damped = edited_as<DiscreteFilter>(channel, {1.0, 1.0, 0.0, 3.0});
  const double closer = std::pow(r, 3.0);
  CHECK(damped.denominator[1] == Approx(-2.0 * closer * std::cos(w)).epsilon(1e-12));
  CHECK(damped.denominator[2] == Approx(closer * closer).epsilon(1e-12));
  const auto slower = edited_as<DiscreteFilter>(channel, {1.0, 2.0, 0.0});
  CHECK(slower.denominator[1] == Approx(-2.0 * std::sqrt(r) * std::cos(w / 2)).epsilon(1e-12));
  CHECK(slower.denominator[2] == Approx(r).epsilon(1e-12));
  const double gain = 0.5 / (1.0 - 2.0 * r * std::cos(w) + r * r);
  CHECK(steady_gain(damped) == Approx(gain).epsilon(1e-12));
  CHECK(steady_gain(slower) == Approx(gain).epsilon(1e-12));
  CHECK(rings(channel));
  CHECK_FALSE(rings(filter({1.0}, {1.0, -1.1, 0.24}, 0)));  // poles 0.8 and 0.3
  CHECK_FALSE(rings(lag(0, 0, 1.0, 10.0)));
}

// 2 s a sample. Part p of a sample later: (1 - p) of the response where it is, p a sample later.
TEST_CASE("a filter's dead time moves by parts of a sample too") {
  const ChannelSpec channel = filter({1.0, 0.4}, {1.0, -0.5}, 3);
  const auto delayed = [&](double error_s) {
    return edited_as<DiscreteFilter>(channel, {1.0, 1.0, error_s}, 2.0);
  };
  const auto check = [&](double error_s, int delay, const std::vector<double>& numerator) {
    CAPTURE(error_s);
    const DiscreteFilter filter = delayed(error_s);
    CHECK(filter.delay_samples == delay);
    REQUIRE(filter.numerator.size() == numerator.size());
    for (std::size_t i = 0; i < numerator.size(); ++i)
      CHECK(filter.numerator[i] == Approx(numerator[i]).epsilon(1e-12));
    CHECK(steady_gain(filter) == Approx(2.8).epsilon(1e-12));
  };
  check(0.5, 3, {0.75, 0.25 + 0.3, 0.1});
  check(2.0, 4, {1.0, 0.4});
  check(-3.0, 1, {0.5, 0.5 + 0.2, 0.2});
  check(-100.0, 0, {1.0, 0.4});
}

// s(k) of the slower one at k is s of the other at half the way: equal at every other row, the mean
// of two neighbours between them.
TEST_CASE("a step response is stretched about its dead time") {
  const ChannelSpec channel = response({0.0, 0.0, 0.0, 4.0, 6.0, 7.0});  // dead time 2
  const auto slower = edited_as<StepResponse>(channel, {0.5, 2.0, 0.0});
  CHECK(slower.values == std::vector<double>{0.0, 0.0, 0.0, 1.0, 2.0, 2.5, 3.0, 3.25, 3.5});
  const auto later = edited_as<StepResponse>(channel, {1.0, 1.0, 1.0});
  CHECK(later.values == std::vector<double>{0.0, 0.0, 0.0, 0.0, 4.0, 6.0, 7.0});
  const auto earliest = edited_as<StepResponse>(channel, {1.0, 1.0, -10.0});
  CHECK(earliest.values == std::vector<double>{0.0, 4.0, 6.0, 7.0});
}

TEST_CASE("no more dead time can be taken from a channel than it has") {
  CHECK(removable_dead_time_s(lag(0, 0, 1.0, 10.0, 3.5), 1.0) == 3.5);
  CHECK(removable_dead_time_s(filter({1.0}, {1.0}, 4), 0.5) == 2.0);
  CHECK(removable_dead_time_s(tanks(), 1.0) == 6.0);
  CHECK(removable_dead_time_s(response({0.0, 0.0, 0.0, 1.0, 2.0}), 10.0) == 20.0);
  CHECK(removable_dead_time_s(response({1.0, 2.0}), 10.0) == 0.0);
}

// Of the poles: e^{-Ts/T}.
TEST_CASE("the slowest time constant of every kind of channel") {
  const ChannelSpec two{0, 0, TransferFunction{1.0, {10.0, 40.0}, 0.0, 0.0, false}, {}};
  CHECK(slowest_time_constant_s(two, 2.0) == Approx(40.0).epsilon(1e-9));
  CHECK(slowest_time_constant_s(filter({1.0}, {1.0, -std::exp(-2.0 / 30.0)}, 0), 2.0) ==
        Approx(30.0).epsilon(1e-9));
  CHECK(slowest_time_constant_s(tanks(), 1.0) == 35.0);
  CHECK(slowest_time_constant_s(lag(0, 0, 1.0, 0.1), 1.0) == 1.0);  // one sample at least
}

TEST_CASE("a channel alone is a model of one input and one CV around zero") {
  ChannelSpec channel = lag(2, 3, 1.5, 10.0);
  channel.input_block = Deadband{0.1};
  const ModelSpec model = alone(channel, 2.0);
  CHECK(model.sample_time_s == 2.0);
  CHECK(model.input_count == 1);
  CHECK(model.cv_count == 1);
  REQUIRE(model.channels.size() == 1);
  CHECK(model.channels[0].cv == 0);
  CHECK(model.channels[0].input == 0);
  CHECK_FALSE(model.channels[0].input_block);
  CHECK(model.input_origin(0) == 0.0);
  CHECK(model.output_origin(0) == 0.0);
}

// x(k+1) = p x(k) + (1-p) u(k), y = 3 x: y(k) = 3 (1 - p^k) after a step; the second CV never
// moves.
TEST_CASE("a state space becomes the step responses of its channels") {
  const double pole = 0.9;
  ModelSpec model = test::model_of({}, 1, 2);
  StateSpaceSpec states;
  states.a = Eigen::MatrixXd::Constant(1, 1, pole);
  states.b = Eigen::MatrixXd::Constant(1, 1, 1.0 - pole);
  states.c = Eigen::MatrixXd::Zero(2, 1);
  states.c(0, 0) = 3.0;
  states.d = Eigen::MatrixXd::Zero(2, 1);
  model.state_space = states;
  const ModelSpec channels = in_channels(model);
  CHECK_FALSE(channels.state_space);
  REQUIRE(channels.channels.size() == 1);
  CHECK(channels.channels[0].cv == 0);
  const auto& values = std::get<StepResponse>(channels.channels[0].dynamics).values;
  REQUIRE(values.size() > 100);
  for (std::size_t k = 0; k < values.size(); ++k)
    CHECK(values[k] == Approx(3.0 * (1.0 - std::pow(pole, static_cast<double>(k)))).margin(1e-12));
  CHECK(values.back() == Approx(3.0).epsilon(1e-5));
}

// A level behind a lag: it goes on rising for as long as one likes, and as the state space does.
TEST_CASE("a state space that integrates goes on integrating as channels") {
  constexpr double pole = 0.8, slope = 0.02;
  ModelSpec model;
  model.sample_time_s = 2.0;
  model.input_count = 1;
  model.cv_count = 2;
  StateSpaceSpec states;
  states.a = (Eigen::MatrixXd(2, 2) << 1.0, slope, 0.0, pole).finished();
  states.b = (Eigen::MatrixXd(2, 1) << 0.0, 1.0 - pole).finished();
  states.c = (Eigen::MatrixXd(2, 2) << 1.0, 0.0, 0.0, 3.0).finished();
  states.d = Eigen::MatrixXd::Zero(2, 1);
  model.state_space = states;
  const ModelSpec channels = in_channels(model);
  REQUIRE(channels.channels.size() == 2);
  LinearModel whole(model), parts(channels);
  CHECK(parts.integrating()(0, 0));
  CHECK_FALSE(parts.integrating()(1, 0));
  CHECK(parts.steady_gain()(0, 0) == Approx(slope).epsilon(1e-5));
  for (int k = 0; k < 20000; ++k) {
    const Eigen::VectorXd input = Eigen::VectorXd::Constant(1, k < 19000 ? 1.0 : -2.0);
    whole.advance(input);
    parts.advance(input);
    // The pulse response is taken for its slope from where a millionth is left.
    REQUIRE(parts.output()(0) == Approx(whole.output()(0)).epsilon(2e-6).margin(1e-6));
    REQUIRE(parts.output()(1) == Approx(whole.output()(1)).epsilon(2e-6).margin(1e-5));
  }
  // Half the gain, two and a half samples later.
  ChannelSpec other = edited(channels.channels[0], {0.5, 1.0, 5.0}, model.sample_time_s);
  ModelSpec changed = channels;
  changed.channels = {other};
  LinearModel later(changed), now(channels);
  std::vector<double> one, two;
  for (int k = 0; k < 300; ++k) {
    later.advance(Eigen::VectorXd::Ones(1));
    now.advance(Eigen::VectorXd::Ones(1));
    one.push_back(later.output()(0));
    two.push_back(now.output()(0));
  }
  for (std::size_t k = 3; k < one.size(); ++k)
    CHECK(one[k] == Approx(0.25 * (two[k - 2] + two[k - 3])).margin(1e-9));
}

}  // namespace
}  // namespace mpm
