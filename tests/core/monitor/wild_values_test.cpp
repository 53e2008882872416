#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "core/monitor/monitor.hpp"
#include "tests/core/open_loop_unit.hpp"

namespace mpm {
namespace {

constexpr int kMemory = 2000;  // samples: the default

struct Injury {
  SignalKind kind = SignalKind::kMv;
  double value = 0.0;
  int from = 0, samples = 0;
};

struct Outcome {
  std::string verdicts;     // after the last sample: mmMu ...
  std::string transitions;  // "cv input"
  std::uint64_t bad_values = 0;
};

Outcome outcome(const test::OpenLoopUnit& unit, bool predictions, const Injury& injury,
                int samples) {
  Monitor monitor(unit.model, unit.counts, {predictions, predictions}, {}, {});
  Outcome result;
  unit.run(samples, [&](Frame frame) {
    const auto at = static_cast<int>(frame.interval) - injury.from;
    if (at >= 0 && at < injury.samples) frame[injury.kind].values(0) = injury.value;
    monitor.push(frame);
    for (const AlarmTransition& moved : monitor.transitions())
      result.transitions += std::to_string(moved.cv) + std::to_string(moved.input) + ' ';
  });
  for (int cv = 0; cv < 2; ++cv)
    for (int input = 0; input < 2; ++input)
      result.verdicts += std::to_string(static_cast<int>(monitor.channel(cv, input).verdict));
  result.bad_values = monitor.counters().bad_values;
  return result;
}

/// The injured unit and its twin two memories after the last wild value.
void check_healed(double gain_ratio, bool predictions, const Injury& injury) {
  CAPTURE(gain_ratio, predictions, static_cast<int>(injury.kind), injury.value, injury.from,
          injury.samples);
  test::OpenLoopUnit unit;
  unit.gain_ratio = gain_ratio;
  const int samples = injury.from + injury.samples + 2 * kMemory;
  const Outcome healthy = outcome(unit, predictions, {}, samples);
  const Outcome injured = outcome(unit, predictions, injury, samples);
  CHECK(injured.verdicts == healthy.verdicts);
  // What the twin alarms of, once; nothing else, though it may come again after a fresh start.
  CHECK((injured.transitions == healthy.transitions ||
         (gain_ratio != 1.0 && injured.transitions.find_first_not_of("01 ") == std::string::npos &&
          injured.transitions.find("00") == std::string::npos &&
          injured.transitions.find("1 ") == injured.transitions.find("01 ") + 1)));
}

TEST_CASE("a single wild value leaves no trace", "[trials]") {
  for (const double value : {300.0, -1e5, 1e9, 1e60, 1e153, -1e200, 1e308})
    for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv, SignalKind::kPrediction})
      check_healed(1.0, true, {kind, value, 1500, 1});
  check_healed(0.75, true, {SignalKind::kMv, 1e153, 1500, 1});
  check_healed(0.75, true, {SignalKind::kCv, 1e60, 1500, 1});
}

TEST_CASE("a burst of wild values is forgotten within two memories", "[trials]") {
  for (const double value : {1e9, -1e60, 1e153, 1e200})
    for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv, SignalKind::kPrediction})
      check_healed(1.0, true, {kind, value, 1500, 7});
  check_healed(0.75, true, {SignalKind::kMv, 1e60, 1500, 7});
}

TEST_CASE("what is simulated from a wild input is forgotten too") {
  for (const double value : {1e5, 1e60, 1e200})
    for (const int samples : {1, 7})
      check_healed(1.0, false, {SignalKind::kMv, value, 1500, samples});
}

TEST_CASE("what a signal said while it was elsewhere is forgotten once it is back") {
  for (const double value : {1e6, 1e9})
    for (const bool predictions : {true, false})
      check_healed(1.0, predictions, {SignalKind::kMv, value, 1500, 100});
}

TEST_CASE("a wild value among the first is forgotten too") {
  for (const double value : {1e6, 1e60, 1e200})
    for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv})
      for (const int from : {0, 5}) check_healed(1.0, true, {kind, value, from, 1});
}

TEST_CASE("values that no instrument gives count as bad") {
  CHECK(outcome({}, true, {SignalKind::kMv, 1e153, 500, 3}, 600).bad_values == 3);
}

}  // namespace
}  // namespace mpm
