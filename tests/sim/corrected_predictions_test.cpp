#include <catch2/catch.hpp>
#include <cmath>

#include "core/monitor/monitor.hpp"
#include "sim/scenario/prepare.hpp"
#include "tests/sim/units.hpp"

namespace corrected_predictions_test {

namespace {

using mpm::AlarmState;
using mpm::Monitor;
using mpm::SignalKind;

struct Outcome {
  int corrected = 0;  // CVs whose predictions are recognised
  int alarms = 0;
  bool found = false;  // an alarm stands on u3 -> y2
  double gain_error = 0.0;
};

/// Shell 3 x 3 whose control system gives predictions with an output-bias update, to five digits;
/// `gain_ratio` of u3 -> y2 in the plant.
Outcome run(double share, std::uint64_t seed, double gain_ratio) {
  mpm::sim::LoopSetup setup = mpm::test::healthy_loop(mpm::test::load_plant("shell3x3"), seed);
  setup.samples = 3000;
  if (gain_ratio != 1.0) setup.scenario.changes = {mpm::test::gain_change("y2", "u3", gain_ratio)};
  mpm::sim::hide_changes(setup);
  mpm::sim::ClosedLoop loop(setup);
  Monitor monitor(setup.unit.model, setup.unit.counts(), {true, true, true}, {}, {});
  Outcome outcome;
  Eigen::VectorXd bias = Eigen::VectorXd::Zero(3);
  for (int k = 0; k < 3000; ++k) {
    mpm::Frame frame = loop.step();
    auto& predicted = frame[SignalKind::kPrediction].values;
    const Eigen::VectorXd digits = (1e5 * (predicted + bias)).array().round() / 1e5;
    predicted = digits;
    bias += share * (frame[SignalKind::kCv].values - predicted);
    monitor.push(frame);
    for (const mpm::AlarmTransition& change : monitor.transitions())
      outcome.alarms += change.to == AlarmState::kActive ? 1 : 0;
  }
  for (int j = 0; j < 3; ++j) outcome.corrected += monitor.corrected(j) ? 1 : 0;
  outcome.found = monitor.alarm(1, 2) == AlarmState::kActive;
  const mpm::ChannelStatus& channel = monitor.channel(1, 2);
  outcome.gain_error = channel.effect_size / channel.model_gain;
  return outcome;
}

}  // namespace

// Taken at their word, such predictions made 40 % less gain "+0.15 % (0.058 to 0.25)".
TEST_CASE("a wrong gain is found though predictions are corrected by the measurement") {
  for (const double share : {0.3, 1.0})
    for (std::uint64_t seed = 7101; seed <= 7103; ++seed) {
      CAPTURE(share, seed);
      const Outcome outcome = run(share, seed, 0.6);
      CHECK(outcome.corrected == 3);
      CHECK(outcome.found);
      CHECK(outcome.gain_error == Approx(-0.4).margin(0.2));
      const Outcome sound = run(share, seed + 10, 1.0);
      CHECK(sound.corrected == 3);
      CHECK(sound.alarms == 0);
    }
}

}  // namespace corrected_predictions_test
