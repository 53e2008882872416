// What the monitor says while data are too few, or inputs move too little or together.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/core/monitor/experiment.hpp"

namespace mpm {
namespace {

using test::Experiment;

TEST_CASE("without movement of any manipulated variable the controller is off") {
  const Experiment experiment;
  Monitor monitor = experiment.monitor();
  experiment.run(2000, [&](const Frame& original) {
    Frame frame = original;
    frame[SignalKind::kMv].values = experiment.model.input_origin;
    frame[SignalKind::kCv].values -= frame[SignalKind::kPrediction].values;
    frame[SignalKind::kPrediction].values.setZero();
    monitor.push(frame);
  });
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) CHECK(monitor.channel(j, i).reason == Reason::kControllerOff);
}

TEST_CASE("before there is enough data nothing is said") {
  const Experiment experiment;
  Monitor monitor = experiment.monitor();
  experiment.run(100, [&](const Frame& frame) { monitor.push(frame); });
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      CHECK(monitor.channel(j, i).verdict == Verdict::kUndetermined);
      CHECK(monitor.channel(j, i).reason == Reason::kWarmingUp);
    }
}

TEST_CASE("an alarm that another monitor raised clears on evidence, once") {
  Experiment experiment;
  Monitor monitor = experiment.monitor();
  monitor.stand(0, 1);
  CHECK(monitor.alarm(0, 1) == AlarmState::kActive);
  std::vector<AlarmTransition> all;
  const auto push = [&](const Frame& frame) {
    monitor.push(frame);
    all.insert(all.end(), monitor.transitions().begin(), monitor.transitions().end());
  };
  SECTION("of a channel that matches") {
    experiment.run(2000, push);
    REQUIRE(all.size() == 1);
    CHECK(all[0].cv == 0);
    CHECK(all[0].input == 1);
    CHECK(all[0].to == AlarmState::kCleared);
  }
  SECTION("not of one that is as wrong as was said") {
    experiment.gain_ratio = 0.6;
    experiment.run(2000, push);
    CHECK(all.empty());
    CHECK(monitor.alarm(0, 1) == AlarmState::kActive);
  }
  SECTION("nor of one that says nothing") {
    experiment.still_from = 0;
    experiment.run(2000, push);
    CHECK(all.empty());
    CHECK(monitor.channel(0, 1).reason == Reason::kWeakExcitation);
    CHECK(monitor.alarm(0, 1) == AlarmState::kActive);
  }
}

TEST_CASE("an input that stands still is undetermined") {
  const Experiment experiment;
  Monitor monitor = experiment.monitor();
  experiment.run(2000, [&](const Frame& original) {
    Frame frame = original;
    frame[SignalKind::kMv].values(1) = -3.0;
    monitor.push(frame);
  });
  monitor.correlate();
  for (int j = 0; j < 2; ++j) {
    CHECK(monitor.channel(j, 1).verdict == Verdict::kUndetermined);
    CHECK(monitor.channel(j, 1).reason == Reason::kNotExcited);
    CHECK(monitor.partial_correlations(j, 1).isZero(0.0));
  }
}

TEST_CASE("inputs that move as one name each other") {
  Experiment experiment;
  Monitor monitor = experiment.monitor();
  experiment.run(2000, [&](const Frame& original) {
    Frame frame = original;
    frame[SignalKind::kMv].values(1) = 3.0 * frame[SignalKind::kMv].values(0);
    monitor.push(frame);
  });
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      CHECK(monitor.channel(j, i).verdict == Verdict::kUndetermined);
      CHECK(monitor.channel(j, i).reason == Reason::kCollinear);
      CHECK(monitor.channel(j, i).confounder == 1 - i);
      CHECK(std::isfinite(monitor.channel(j, i).p_value));
      CHECK(std::isfinite(monitor.channel(j, i).effect_size));
    }
}

TEST_CASE("an input that stands still leaves the others their verdicts") {
  for (const bool predictions : {true, false}) {
    for (const int from : {0, 500}) {
      CAPTURE(from, predictions);
      Experiment experiment;
      experiment.predictions = predictions;
      experiment.graded = true;
      experiment.still_from = from;
      Monitor monitor = experiment.monitor();
      experiment.run(4000, [&](const Frame& frame) { monitor.push(frame); });
      for (int j = 0; j < 2; ++j) CHECK(monitor.channel(j, 0).verdict == Verdict::kMatch);
      if (from == 0)
        for (int j = 0; j < 2; ++j) CHECK(monitor.channel(j, 1).reason == Reason::kNotExcited);
    }
  }
}

}  // namespace
}  // namespace mpm
