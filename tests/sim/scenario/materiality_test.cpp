#include "sim/scenario/materiality.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "tests/sim/units.hpp"

namespace {

using mpm::SignalKind;
using mpm::sim::ChannelChange;
using mpm::sim::ChannelLimit;
using mpm::sim::control_cost;
using mpm::sim::CostRuns;
using mpm::sim::LoopSetup;

/// Two CVs by two MVs; the second CV has no weight, so nothing about it can cost anything.
LoopSetup small_loop() {
  const mpm::config::LoadResult loaded = mpm::config::load_unit_text(
      "unit: small\nsample_time: 2\nsignals: {mv: [u1, u2], cv: [y1, y2]}\n"
      "model:\n  channels:\n"
      "    - {cv: y1, mv: u1, gain: 2, time_constants: [30], dead_time: 6}\n"
      "    - {cv: y1, mv: u2, gain: 0.5, time_constants: [20], dead_time: 4}\n"
      "    - {cv: y2, mv: u2, gain: 1, time_constants: [20], dead_time: 4}\n"
      "simulation:\n  prediction_horizon: 40\n  move_blocks: [3, 5, 10]\n"
      "  cv_weights: {y1: 1, y2: 0}\n  move_weights: {u1: 1, u2: 2}\n"
      "  noise: {sigma: 0.02, pole: 0.9}\n  setpoints: {amplitude: 0.5, hold: 40}\n",
      "small.yaml");
  for (const mpm::config::Finding& finding : loaded.findings)
    FAIL_CHECK(mpm::config::format(finding));
  return mpm::test::healthy_loop(loaded.config, 7);
}

const CostRuns kRuns{400, 2};

double cost_with(const LoopSetup& setup, const ChannelChange& change) {
  LoopSetup changed = setup;
  changed.changes = {change};
  return control_cost(changed, kRuns) / control_cost(setup, kRuns);
}

}  // namespace

TEST_CASE("the cost is the weighted sum of errors and moves") {
  const LoopSetup setup = small_loop();
  double expected = 0.0;
  for (const std::uint64_t seed : {7U, 8U}) {
    LoopSetup each = setup;
    each.seed = seed;
    mpm::sim::ClosedLoop loop(each);
    double u1 = 0.0, u2 = 0.0;
    for (int k = 0; k < 400; ++k) {
      const mpm::Frame& frame = loop.step();
      const double error =
          frame[SignalKind::kSetpoint].values(0) - frame[SignalKind::kCv].values(0);
      const auto& moved = frame[SignalKind::kMv].values;
      expected += error * error + std::pow(moved(0) - u1, 2) + 2.0 * std::pow(moved(1) - u2, 2);
      u1 = moved(0);
      u2 = moved(1);
    }
  }
  CHECK(control_cost(setup, kRuns) == Approx(expected).epsilon(1e-12));
  const double early = control_cost(setup, kRuns, expected / 2.0);
  CHECK(early > expected / 2.0);
  CHECK(early < expected);
}

TEST_CASE("limits are where the cost has risen by what was asked for") {
  const LoopSetup setup = small_loop();
  const double rise = 0.3;
  const std::vector<ChannelLimit> limits = mpm::sim::materiality_limits(setup, rise, kRuns);
  REQUIRE(limits.size() == 3);  // channels that exist
  const ChannelLimit& main = limits[0];
  CHECK(main.cv == 0);
  CHECK(main.input == 0);

  REQUIRE_FALSE(main.gain.capped);
  const double gain = main.gain.error;
  CHECK(gain > 0.05);
  CHECK(gain < 1.0);
  const double worse =
      std::max(cost_with(setup, {0, 0, 1.0 + gain}), cost_with(setup, {0, 0, 1.0 - gain}));
  CHECK(worse > 1.0 + rise);
  // 4 % below it neither direction costs so much.
  CHECK(cost_with(setup, {0, 0, 1.0 + 0.96 * gain}) < 1.0 + rise);
  CHECK(cost_with(setup, {0, 0, 1.0 - 0.96 * gain}) < 1.0 + rise);

  REQUIRE_FALSE(main.dead_time.capped);
  const double dead_time = main.dead_time.error;
  CHECK(dead_time < 20 * 2.0);
  CHECK(cost_with(setup, {0, 0, 1.0, 1.0, 0.96 * dead_time}) < 1.0 + rise);
  CHECK(std::max(cost_with(setup, {0, 0, 1.0, 1.0, dead_time}),
                 cost_with(setup, {0, 0, 1.0, 1.0, -std::min(6.0, dead_time)})) > 1.0 + rise);

  for (const ChannelLimit::Value& value :
       {limits[2].gain, limits[2].time_constant, limits[2].dead_time})
    CHECK(value.capped);
  CHECK(limits[2].gain.error == 1.0);
  CHECK(limits[2].time_constant.error == 1.0);
  CHECK(limits[2].dead_time.error == 40.0);

  // The same again, number for number; and more is allowed where more may be lost.
  const std::vector<ChannelLimit> again = mpm::sim::materiality_limits(setup, rise, kRuns);
  CHECK(again[1].gain.error == limits[1].gain.error);
  const std::vector<ChannelLimit> wider = mpm::sim::materiality_limits(setup, 2.0 * rise, kRuns);
  CHECK(wider[0].gain.error > gain);
  CHECK(wider[0].dead_time.error > dead_time);
}

TEST_CASE("limits are printed as a block of the unit file") {
  const LoopSetup setup = small_loop();
  std::ostringstream out;
  mpm::sim::print_limits(out, setup,
                         {{0, 0, {0.1234, false}, {0.5, false}, {2.14, false}},
                          {1, 1, {1.0, true}, {1.0, true}, {1234.0, false}}},
                         0.2);
  const std::string text = out.str();
  CHECK(text.substr(text.find("monitor:")) ==
        "monitor:\n"
        "  materiality:\n"
        "    channels:             # relative, relative, s\n"
        "      - {cv: y1, mv: u1, gain: 0.12, time_constant: 0.5, dead_time: 2.1}\n"
        "      - {cv: y2, mv: u2, gain: 1, time_constant: 1, dead_time: 1200}   # > gain, "
        "time_constant\n");
}

TEST_CASE("a loop without a cost has no limits") {
  LoopSetup setup = small_loop();
  setup.unit = mpm::test::without_noise(setup.unit);
  setup.scenario.constant_setpoints = true;
  CHECK_THROWS_AS(mpm::sim::materiality_limits(setup, 0.2, kRuns), std::invalid_argument);
}
