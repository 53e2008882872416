// What the monitor makes of data that are missing, marked, implausible or compressed.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/statistics/compression.hpp"
#include "tests/core/counter_noise.hpp"
#include "tests/core/monitor/experiment.hpp"

namespace mpm {
namespace {

using test::Experiment;

TEST_CASE("inputs that are moved now and then are not frozen in between") {
  Experiment experiment;
  experiment.predictions = false;
  experiment.graded = true;  // every 20 samples
  Monitor monitor = experiment.monitor();
  experiment.run(4000, [&](const Frame& frame) { monitor.push(frame); });
  CHECK(monitor.counters().implausible.frozen < 20);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) CHECK(monitor.channel(j, i).verdict == Verdict::kMatch);
}

TEST_CASE(
    "where predictions cease the model makes them, finds what is wrong, and they are back later") {
  Experiment experiment;
  experiment.gain_ratio = GENERATE(1.0, 1.6);
  experiment.from = 4500;
  Monitor monitor = experiment.monitor();
  bool off = false;  // said of any other channel
  experiment.run(8000, [&](Frame frame) {
    const std::int64_t k = frame.interval;
    if (k >= 2000 && k < 6000) frame[SignalKind::kPrediction].quality.assign(2, Quality::kBad);
    monitor.push(frame);
    for (const AlarmTransition& change : monitor.transitions())
      off = off || change.cv != 0 || change.input != 1 || k < experiment.from;
    if (k == 2060) CHECK(monitor.channel(0, 0).reason == Reason::kBadData);
    if (k == 2060) CHECK_FALSE(monitor.replaced(0));
    if (k == 4400 || k == 7900) CHECK(monitor.channel(1, 0).verdict == Verdict::kMatch);
    if (k == 4400) CHECK(monitor.replaced(0));
    if (k == 6010) CHECK(monitor.replaced(0));
    if (k == 7900) CHECK_FALSE(monitor.replaced(0));
    if (k == 5900 || k == 7900)
      CHECK((monitor.alarm(0, 1) == AlarmState::kActive) == (experiment.gain_ratio > 1.0));
  });
  CHECK_FALSE(off);
}

TEST_CASE("an input that is missing is named where a CV cannot be simulated without it") {
  Experiment experiment;
  experiment.predictions = false;
  Monitor monitor = experiment.monitor();
  experiment.run(1000, [&](Frame frame) {
    frame[SignalKind::kMv].quality[1] = Quality::kBad;
    monitor.push(frame);
  });
  CHECK(monitor.channel(0, 0).reason == Reason::kBadData);
  CHECK(monitor.channel(0, 0).confounder == 1);
  CHECK(monitor.channel(0, 1).reason == Reason::kBadData);
  CHECK(monitor.channel(0, 1).confounder == -1);
}

TEST_CASE("a compressed CV has no verdict, and what was learnt of it is forgotten") {
  Experiment experiment;
  Monitor monitor = experiment.monitor();
  double held = 0.0;
  Reason before = Reason::kNone;
  double remembered = 1e9;  // when it is no longer compressed
  experiment.run(7000, [&](Frame frame) {
    double& value = frame[SignalKind::kCv].values(0);
    if (std::abs(value - held) > 0.3) held = value;
    if (frame.interval < 3000) value = held;
    monitor.push(frame);
    CHECK(monitor.transitions().empty());
    if (frame.interval == 2900)
      for (int i = 0; i < 2; ++i) CHECK(monitor.channel(0, i).reason == Reason::kCompressed);
    if (frame.interval == 2900) CHECK(monitor.channel(1, 0).verdict == Verdict::kMatch);
    const Reason reason = monitor.channel(0, 0).reason;
    if (before == Reason::kCompressed && reason != before)
      remembered = monitor.channel(0, 0).effective_samples;
    before = reason;
  });
  CHECK(remembered < 10.0);
  for (int i = 0; i < 2; ++i) CHECK(monitor.channel(0, i).verdict == Verdict::kMatch);
}

TEST_CASE("a CV that is simulated from a compressed input has no verdict") {
  // An MV that wanders, held until it has left a deadband of half its s.d.
  Experiment experiment;
  experiment.predictions = GENERATE(true, false);
  Monitor monitor = experiment.monitor();
  double held = 0.0;
  experiment.run(4000, [&](Frame frame) {
    double& value = frame[SignalKind::kMv].values(1);
    const double moved = value + test::coloured(900, static_cast<int>(frame.interval));
    if (std::abs(moved - held) > 0.3) held = moved;
    value = held;
    monitor.push(frame);
    CHECK(monitor.transitions().empty());
  });
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const ChannelStatus& channel = monitor.channel(j, i);
      CHECK((channel.reason == Reason::kCompressed) == !experiment.predictions);
      if (!experiment.predictions) CHECK(channel.confounder == 1);
    }
}

TEST_CASE("an input that is held within what no CV shows is no reason for silence") {
  // A controller that moves its MV at most samples, and by no less than a step.
  Experiment experiment;
  experiment.predictions = false;
  Monitor monitor = experiment.monitor();
  Compression looks;
  double held = 0.0;
  experiment.run(4000, [&](Frame frame) {
    double& value = frame[SignalKind::kMv].values(1);
    const double moved = value + 0.2 * test::uniform(900, frame.interval);
    if (std::abs(moved - held) > 0.05) held = moved;
    value = held;
    looks.take(value);
    monitor.push(frame);
    CHECK(monitor.transitions().empty());
  });
  CHECK(looks.kind() == Compression::Kind::kHeld);  // as a historian would leave it
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) CHECK(monitor.channel(j, i).verdict == Verdict::kMatch);
}

TEST_CASE("implausible values are a part of the bad ones at every moment") {
  Experiment experiment;
  experiment.predictions = GENERATE(true, false);
  Monitor monitor = experiment.monitor();
  experiment.run(1000, [&](const Frame& original) {
    Frame frame = original;
    if (original.interval > 500) {  // measurement and prediction stand still, to the end
      frame[SignalKind::kCv].values(0) = 50.25;
      frame[SignalKind::kPrediction].values(0) = 50.125;
    }
    monitor.push(frame);
    const ScreenCounters& implausible = monitor.counters().implausible;
    REQUIRE(implausible.frozen + implausible.clipped + implausible.spikes <=
            monitor.counters().bad_values);
  });
  CHECK(monitor.counters().implausible.frozen > 400);
}

// Steps of ten s.d. of the noise, about as far as a CV moves: what changes with them is no change.
TEST_CASE("a sound CV that is read in steps raises no alarm and no mismatch", "[trials]") {
  constexpr double kStep = 0.8;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    CAPTURE(seed);
    test::OpenLoopUnit unit;
    unit.seed = seed;
    unit.graded = true;
    Monitor monitor(unit.model, unit.counts, {false, false}, {}, {});
    int alarms = 0;
    unit.run(3000, [&](Frame frame) {
      auto& values = frame[SignalKind::kCv].values;
      values = (values.array() / kStep).round() * kStep;
      monitor.push(frame);
      alarms += static_cast<int>(monitor.transitions().size());
    });
    CHECK(alarms == 0);
    for (int cv = 0; cv < 2; ++cv)
      for (int input = 0; input < 2; ++input)
        CHECK(monitor.channel(cv, input).verdict != Verdict::kMismatch);
  }
}

TEST_CASE("gaps, bad values and repeats are counted and skew nothing") {
  const Experiment experiment;
  Monitor monitor = experiment.monitor();
  int transitions = 0;
  experiment.run(4000, [&](const Frame& original) {
    const std::int64_t k = original.interval;
    Frame frame = original;
    if (k % 500 == 100) return;                                  // missing
    if (k % 500 == 200) frame[SignalKind::kCv].values(0) = 1e9;  // far off, but said to be bad
    if (k % 500 == 200) frame[SignalKind::kCv].quality[0] = Quality::kBad;
    if (k % 500 == 300) frame[SignalKind::kMv].values(1) = std::numeric_limits<double>::quiet_NaN();
    monitor.push(frame);
    if (k % 500 == 400) monitor.push(frame);  // repeated
    transitions += static_cast<int>(monitor.transitions().size());
  });
  CHECK(monitor.counters().missing == 8);
  CHECK(monitor.counters().bad_values == 16);
  CHECK(monitor.counters().out_of_order == 8);
  CHECK(transitions == 0);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) CHECK(monitor.channel(j, i).verdict == Verdict::kMatch);
}

TEST_CASE("each frame is judged once, in order, also where several wait for one") {
  const Experiment experiment;
  Monitor monitor = experiment.monitor();
  std::int64_t next = 0;
  std::size_t at_once = 0;
  experiment.run(600, [&](const Frame& original) {
    Frame frame = original;
    if (frame.interval >= 400) frame[SignalKind::kMv].values(0) += 1e3;  // a step that stays
    monitor.push(frame);
    at_once = std::max(at_once, monitor.judged().size());
    for (const JudgedFrame& judged : monitor.judged()) CHECK(judged.interval == next++);
  });
  CHECK(at_once > 1);
  CHECK(next == 600 - Screen::kDelay);
}

TEST_CASE("a signal that stays bad turns every verdict to undetermined") {
  const Experiment experiment;
  Monitor monitor = experiment.monitor();
  experiment.run(2000, [&](const Frame& original) {
    Frame frame = original;
    if (frame.interval > 1900) frame[SignalKind::kMv].quality[0] = Quality::kBad;
    monitor.push(frame);
  });
  CHECK(monitor.channel(0, 0).verdict == Verdict::kUndetermined);
  CHECK(monitor.channel(0, 0).reason == Reason::kBadData);
}

}  // namespace
}  // namespace mpm
