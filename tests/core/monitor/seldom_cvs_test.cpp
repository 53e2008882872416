// CVs that are read only every so many samples are judged at their readings.
#include "core/monitor/seldom_cvs.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/archive/archive.hpp"
#include "tests/core/counter_noise.hpp"
#include "tests/core/monitor/experiment.hpp"

namespace mpm::seldom_cvs_test {
namespace {

constexpr int kSamples = 12000;

/// CV 0 is read every so many samples; between, its reading stands or nothing comes.
struct Analysed : test::Experiment {
  double every = 5.0;
  bool blank = false;
  int until = kSamples;  ///< the cycle
  int stuck = kSamples;  ///< from here on no reading comes

  template <class Each>
  void run(int samples, Each each) const {
    double reading = 0.0;
    std::int64_t last = -1;
    test::Experiment::run(samples, [&](Frame frame) {
      const auto number =
          static_cast<std::int64_t>(std::floor(static_cast<double>(frame.interval) / every));
      SignalBlock& measured = frame[SignalKind::kCv];
      const bool reads = frame.interval >= until || number != last;
      if (reads && frame.interval < stuck) reading = measured.values(0);
      last = number;
      if (blank && !reads) measured.quality[0] = Quality::kBad;
      measured.values(0) = reading;
      each(frame);
    });
  }
};

std::vector<int> all_verdicts(const Monitor& monitor, Verdict verdict) {
  std::vector<int> channels;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i)
      if (monitor.channel(j, i).verdict == verdict) channels.push_back(10 * j + i);
  return channels;
}

}  // namespace

TEST_CASE("a sound unit with an analyser matches in every channel, and nothing is raised",
          "[trials]") {
  Analysed unit;
  unit.every = GENERATE(2.0, 5.0, 10.3);
  unit.blank = GENERATE(false, true);
  unit.predictions = GENERATE(true, false);
  Monitor monitor = unit.monitor();
  int raised = 0;
  unit.run(kSamples, [&](const Frame& frame) {
    monitor.push(frame);
    raised += static_cast<int>(monitor.transitions().size());
  });
  CHECK(raised == 0);
  CHECK(monitor.read_every(0) == Approx(unit.every).margin(0.05));
  CHECK(monitor.read_every(1) == 0.0);
  CHECK(all_verdicts(monitor, Verdict::kMatch) == std::vector{0, 1, 10, 11});
  CHECK(monitor.lost().empty());
  // Those of the cycles until it was known to be one.
  CHECK(static_cast<double>(monitor.counters().bad_values) < 30.0 * unit.every);
}

TEST_CASE("what is wrong in a channel to an analyser is found, in its size, and no other channel") {
  Analysed unit;
  const bool gain = GENERATE(true, false);
  (gain ? unit.gain_ratio : unit.later) = gain ? 1.6 : 10.0;
  unit.every = GENERATE(2.0, 5.0, 10.3);
  unit.predictions = GENERATE(true, false);
  Monitor monitor = unit.monitor();
  std::vector<AlarmTransition> raised;
  unit.run(kSamples, [&](const Frame& frame) {
    monitor.push(frame);
    raised.insert(raised.end(), monitor.transitions().begin(), monitor.transitions().end());
  });
  CHECK(all_verdicts(monitor, Verdict::kMismatch) == std::vector{1});
  REQUIRE(raised.size() == 1);
  CHECK(raised[0].cv == 0);
  CHECK(raised[0].input == 1);
  CHECK(monitor.alarm(0, 1) == AlarmState::kActive);
  const ChannelStatus& channel = monitor.channel(0, 1);
  // Of a gain of -1; samples. Three s.d.: each misses once in 370, the seeds are fixed.
  if (gain)
    CHECK(std::abs(channel.effect_size - -0.6) < 0.77 * (channel.effect_high - channel.effect_low));
  else
    CHECK(std::abs(channel.dead_time_error.value - 10.0) < 3.0 * channel.dead_time_error.deviation);
}

TEST_CASE("channels in samples are judged at readings as well") {
  Analysed unit;
  const LinearModel exact(unit.model);
  for (int input = 0; input < 2; ++input) {
    const Eigen::VectorXd pulse = exact.impulse_response(0, input, 120);
    StepResponse step{{0.0}};
    for (int k = 1; k < pulse.size(); ++k) step.values.push_back(step.values.back() + pulse(k));
    unit.model.channels[static_cast<std::size_t>(input)].dynamics = step;
  }
  unit.predictions = false;
  Analysed truth;
  truth.gain_ratio = GENERATE(1.0, 1.6);
  Monitor monitor = unit.monitor();
  truth.run(kSamples, [&](Frame frame) {
    frame[SignalKind::kPrediction].quality.assign(2, Quality::kBad);
    monitor.push(frame);
  });
  CHECK(all_verdicts(monitor, Verdict::kMismatch) ==
        (truth.gain_ratio > 1.0 ? std::vector{1} : std::vector<int>{}));
}

TEST_CASE("an analyser's CV that is simulated from a compressed input has no verdict") {
  // An MV that wanders, held until it has left a wide deadband.
  Analysed unit;
  unit.predictions = false;
  Monitor monitor = unit.monitor();
  double held = 0.0;
  unit.run(kSamples, [&](Frame frame) {
    double& value = frame[SignalKind::kMv].values(1);
    const double moved = value + test::coloured(900, frame.interval);
    if (std::abs(moved - held) > 1.2) held = moved;
    value = held;
    frame[SignalKind::kPrediction].quality.assign(2, Quality::kBad);
    monitor.push(frame);
    CHECK(monitor.alarm(0, 1) == AlarmState::kCleared);
  });
  CHECK(monitor.read_every(0) == 5.0);
  for (int i = 0; i < 2; ++i) CHECK(monitor.channel(0, i).reason == Reason::kCompressed);
  CHECK(monitor.channel(0, 0).confounder == 1);
}

TEST_CASE("an analyser that stands still is bad data, and lost") {
  Analysed unit;
  unit.stuck = 9000;
  Monitor monitor = unit.monitor();
  unit.run(10500, [&](const Frame& frame) { monitor.push(frame); });
  CHECK(monitor.channel(0, 0).reason == Reason::kBadData);
  CHECK(monitor.channel(1, 0).verdict == Verdict::kMatch);
  REQUIRE(monitor.lost().size() == 1);
  CHECK(monitor.lost()[0].kind == SignalKind::kCv);
}

TEST_CASE("a CV that is read at every sample again is judged at every sample, with its alarm") {
  Analysed unit;
  unit.gain_ratio = 1.6;
  unit.until = 8000;
  Monitor monitor = unit.monitor();
  unit.run(kSamples, [&](const Frame& frame) {
    monitor.push(frame);
    if (frame.interval == 7990) CHECK(monitor.read_every(0) == 5.0);
    if (frame.interval >= 7990) CHECK(monitor.alarm(0, 1) == AlarmState::kActive);
  });
  CHECK(monitor.read_every(0) == 0.0);
  CHECK(all_verdicts(monitor, Verdict::kMismatch) == std::vector{1});
  CHECK(all_verdicts(monitor, Verdict::kMatch) == std::vector{0, 10, 11});
}

TEST_CASE("a monitor that is put away in the middle of a cycle goes on as if it never was") {
  Analysed unit;
  unit.gain_ratio = 1.6;
  unit.every = 10.3;
  Monitor whole = unit.monitor(), first = unit.monitor(), then = unit.monitor();
  std::vector<std::byte> bytes;
  unit.run(6000, [&](const Frame& frame) {
    whole.push(frame);
    if (frame.interval < 3333) first.push(frame);
    if (frame.interval == 3333) {
      bytes = put_away(first);
      take_back(bytes, then);
    }
    if (frame.interval >= 3333) then.push(frame);
  });
  CHECK(put_away(then) == put_away(whole));
}

}  // namespace mpm::seldom_cvs_test
