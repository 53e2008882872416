// What the monitor says while data are too few, or inputs move too little or together.
#include <catch2/catch.hpp>
#include <cmath>

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
