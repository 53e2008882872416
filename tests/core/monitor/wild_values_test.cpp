#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/monitor/monitor.hpp"
#include "tests/core/counter_noise.hpp"
#include "tests/core/open_loop_unit.hpp"

namespace mpm::wild_values_test {
namespace {

constexpr int kMemory = 2000;  // samples: the default

struct Injury {
  SignalKind kind = SignalKind::kMv;
  double value = 0.0;
  int from = 0, samples = 0;
  int index = 0;             // of the signal
  bool alternating = false;  // in sign, around the value that it had
  double around = 0.0;
  int every = 1;  // of its samples, this one and the others are as they were

  [[nodiscard]] double at(int sample) const {
    return around + (alternating && sample % 2 != 0 ? -value : value);
  }
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
    if (at >= 0 && at < injury.samples && at % injury.every == 0)
      frame[injury.kind].values(injury.index) = injury.at(at);
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

struct Range {
  double low = 1e9, high = -1e9;
};

// All that the signal ever is, uninjured: an injury of so many of these is at least as many of what
// it was before.
Range range_of(const test::OpenLoopUnit& unit, SignalKind kind, int index, int samples) {
  Range range;
  unit.run(samples, [&](const Frame& frame) {
    range.low = std::min(range.low, frame[kind].values(index));
    range.high = std::max(range.high, frame[kind].values(index));
  });
  return range;
}

TEST_CASE("a burst of up to ten values of any size, at any time, in any signal leaves no trace",
          "[trials]") {
  constexpr int kTrials = 48, kLast = 1500;
  constexpr int kSamples = kLast + 10 + 2 * kMemory;
  constexpr std::array kKinds = {SignalKind::kMv, SignalKind::kCv, SignalKind::kPrediction};
  std::map<std::pair<double, bool>, Outcome> twins;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto draw = [&](std::uint64_t stream) {  // 0 .. 1
      return 0.5 + 0.5 * test::uniform(900 + stream, trial);
    };
    test::OpenLoopUnit unit;
    unit.gain_ratio = trial % 2 == 0 ? 1.0 : 0.75;
    const bool predictions = trial % 3 != 0;
    Injury injury;
    injury.kind = kKinds[static_cast<std::size_t>(trial / 2) % (predictions ? 3 : 2)];
    injury.index = trial / 6 % 2;
    injury.samples = 1 + static_cast<int>(draw(0) * 9.999);
    injury.from =
        static_cast<int>(trial % 4 < 2 ? draw(1) * 60.0 : 60.0 + draw(1) * (kLast - 60.0));
    injury.alternating = draw(2) < 0.5;
    const Range range = range_of(unit, injury.kind, injury.index, kLast);
    injury.around = draw(3) < 0.5 ? range.low : range.high;
    injury.value = std::pow(10.0, 1.05 + 4.95 * draw(4)) * (range.high - range.low);
    const auto [twin, is_new] = twins.try_emplace({unit.gain_ratio, predictions});
    if (is_new) twin->second = outcome(unit, predictions, {}, kSamples);
    CAPTURE(trial, predictions, static_cast<int>(injury.kind), injury.index, injury.value,
            injury.from, injury.samples, injury.alternating);
    const Outcome injured = outcome(unit, predictions, injury, kSamples);
    CHECK(injured.verdicts == twin->second.verdicts);
    if (injury.from >= 60) CHECK(injured.bad_values > 0);  // earlier, all may begin anew
  }
}

TEST_CASE("a signal that is in another unit for an hour leaves no trace", "[trials]") {
  for (const double gain_ratio : {1.0, 0.75})
    for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv, SignalKind::kPrediction}) {
      CAPTURE(gain_ratio, static_cast<int>(kind));
      test::OpenLoopUnit unit;
      unit.gain_ratio = gain_ratio;
      const auto seen = [&](double factor) {
        Monitor monitor(unit.model, unit.counts, {true, true}, {}, {});
        std::string result;
        unit.run(1560 + kMemory, [&](Frame frame) {
          // Where it stands is 10 and 50, how far it goes 2 and 10: three and a half thousand
          // times.
          if (frame.interval >= 1500 && frame.interval < 1560) frame[kind].values(0) *= factor;
          monitor.push(frame);
          for (const AlarmTransition& moved : monitor.transitions())
            result += std::to_string(moved.cv) + std::to_string(moved.input) + ' ';
        });
        for (int cv = 0; cv < 2; ++cv)
          for (int input = 0; input < 2; ++input)
            result += std::to_string(static_cast<int>(monitor.channel(cv, input).verdict));
        return std::pair(result, monitor.counters().bad_values);
      };
      CHECK(seen(1000.0) == std::pair(seen(1.0).first, std::uint64_t{60}));
    }
}

// Longer than it takes to believe it, and so large that a sample of it outweighs all that follows.
TEST_CASE("a signal that is 1e12 times as large for five minutes is forgotten once it is back") {
  for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv}) {
    CAPTURE(static_cast<int>(kind));
    test::OpenLoopUnit unit;
    unit.gain_ratio = 0.75;
    const auto verdicts = [&](double factor) {
      Monitor monitor(unit.model, unit.counts, {true, true}, {}, {});
      unit.run(1800 + 2 * kMemory, [&](Frame frame) {
        if (frame.interval >= 1500 && frame.interval < 1800) frame[kind].values *= factor;
        monitor.push(frame);
      });
      std::string result;
      for (int cv = 0; cv < 2; ++cv)
        for (int input = 0; input < 2; ++input)
          result += std::to_string(static_cast<int>(monitor.channel(cv, input).verdict));
      return result;
    };
    CHECK(verdicts(1e12) == verdicts(1.0));
  }
}

// The input has stood still for 40 samples.
TEST_CASE("a burst upon a step that has not yet stayed is told from the step") {
  check_healed(1.0, false, {SignalKind::kMv, 2140.0, 47, 5});
}

TEST_CASE("a signal that goes far away and stays there is taken, from its first sample on") {
  for (const int at : {5, 100, 1000}) {
    CAPTURE(at);
    const test::OpenLoopUnit unit;
    Monitor monitor(unit.model, unit.counts, {true, true}, {}, {});
    unit.run(1500, [&](Frame frame) {
      if (frame.interval >= at)
        for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv, SignalKind::kPrediction})
          frame[kind].values.array() += 5000.0;
      monitor.push(frame);
    });
    CHECK(monitor.counters().bad_values == 0);
    CHECK(monitor.counters().implausible.spikes == 0);
    CHECK(monitor.channel(0, 0).verdict == Verdict::kMatch);
  }
}

TEST_CASE("what is simulated from a wild input is forgotten too") {
  for (const double value : {1e5, 1e60, 1e200})
    for (const int samples : {1, 7})
      check_healed(1.0, false, {SignalKind::kMv, value, 1500, samples});
}

TEST_CASE("what a signal said while it was elsewhere is forgotten once it is back", "[trials]") {
  for (const double value : {1e6, 1e9})
    for (const bool predictions : {true, false})
      check_healed(1.0, predictions, {SignalKind::kMv, value, 1500, 100});
  for (const double value : {1e13, 1e60})
    for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv})
      check_healed(0.75, true, {kind, value, 1500, 100});
}

TEST_CASE("a wild value among the first is forgotten too", "[trials]") {
  for (const double value : {1e6, 1e60, 1e200})
    for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv})
      for (const int from : {0, 5}) check_healed(1.0, true, {kind, value, from, 1});
  for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv})
    check_healed(0.75, true, {.kind = kind, .value = 1e13, .from = 1, .samples = 8, .every = 3});
}

// What it was learnt to be is then what it never is; the twin begins when that is over.
TEST_CASE("a signal that is elsewhere from its first sample on is forgotten once it is home") {
  struct Elsewhere {
    SignalKind kind;
    double factor;  // of where it is: another unit
    double wild;    // and this, at random, either way
  };
  constexpr int kLasts = 100;
  for (const Elsewhere& at : {Elsewhere{SignalKind::kCv, 1e5, 0.0},
                              {SignalKind::kCv, 1.0, 1e8},
                              {SignalKind::kMv, 1.0, 1e80},
                              {SignalKind::kMv, 1e6, 0.0},
                              {SignalKind::kPrediction, 1.0, 1e20}}) {
    CAPTURE(static_cast<int>(at.kind), at.factor, at.wild);
    const auto seen = [&](bool injured) {
      test::OpenLoopUnit unit;
      unit.gain_ratio = 0.75;
      Monitor monitor(unit.model, unit.counts, {true, true}, {}, {});
      std::string result;
      unit.run(kLasts + 2 * kMemory, [&](Frame frame) {
        double& value = frame[at.kind].values(0);
        if (injured && frame.interval < kLasts)
          value = at.factor * value + at.wild * test::uniform(950, frame.interval);
        monitor.push(frame);
        for (const AlarmTransition& moved : monitor.transitions())
          if (frame.interval > kLasts + 100 && (moved.cv != 0 || moved.input != 1))
            result += "an alarm that the twin has not ";
      });
      for (int cv = 0; cv < 2; ++cv)
        for (int input = 0; input < 2; ++input)
          result += std::to_string(static_cast<int>(monitor.channel(cv, input).verdict));
      return result;
    };
    CHECK(seen(true) == seen(false));
  }
}

TEST_CASE("values that no instrument gives count as bad") {
  CHECK(outcome({}, true, {SignalKind::kMv, 1e153, 500, 3}, 600).bad_values == 3);
}

// A gateway that swings an MV a thousand times as far about where it stands, or thirty times for
// longer, is no jump that a screen could tell from an operator's step.
TEST_CASE("an input that swings as it never does is forgotten within two memories", "[trials]") {
  for (const double gain_ratio : {1.0, 0.75})
    for (const auto& [factor, lasts] : {std::pair{1000.0, 100}, std::pair{30.0, 400}}) {
      CAPTURE(gain_ratio, factor, lasts);
      test::OpenLoopUnit unit;
      unit.gain_ratio = gain_ratio;
      const auto last = [&, lasts = lasts](double times) {
        Monitor monitor(unit.model, unit.counts, {true, true}, {}, {});
        double mean = 0.0, count = 0.0;
        unit.run(1500 + lasts + 2 * kMemory, [&](Frame frame) {
          double& value = frame[SignalKind::kMv].values(0);
          if (frame.interval < 1500)
            mean += (value - mean) / ++count;
          else if (frame.interval < 1500 + lasts)
            value = mean + times * (value - mean);
          monitor.push(frame);
        });
        std::vector<double> sizes;
        for (int cv = 0; cv < 2; ++cv) {
          const ChannelStatus& status = monitor.channel(cv, 0);
          sizes.push_back(static_cast<double>(status.verdict));
          sizes.push_back(status.smallest_error);
        }
        return sizes;
      };
      const std::vector<double> healthy = last(1.0), injured = last(factor);
      for (std::size_t i = 0; i < healthy.size(); ++i)
        CHECK(injured[i] == Approx(healthy[i]).epsilon(0.2));
    }
}

}  // namespace
}  // namespace mpm::wild_values_test
