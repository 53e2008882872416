// An input that nobody sees for a while goes on moving the plant: what it does through an error of
// its channel must not be laid to the inputs that move with it.
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>

#include "core/monitor/monitor.hpp"
#include "tests/core/open_loop_unit.hpp"

namespace mpm::unseen_inputs_test {
namespace {

struct Outcome {
  std::string wrong;       // alarms that rose of sound channels: "cv input"
  std::uint64_t used = 0;  // frames
  bool found = false;      // the wrong channel's alarm stands in the end
  bool told = false;       // while it was unknown no channel of the CV had a verdict
};

/// Channel (0, 1) has 0.5 times the gain that the model says; input 1 is not seen for `unseen`
/// samples from 2500 on.
Outcome outcome(std::uint64_t seed, bool predictions, int unseen, double gain_ratio = 0.5) {
  test::OpenLoopUnit unit;
  unit.seed = seed;
  unit.gain_ratio = gain_ratio;
  unit.graded = true;
  unit.alike = 0.8;
  Monitor monitor(unit.model, unit.counts, {predictions, predictions}, {}, {});
  Outcome result;
  constexpr int kFrom = 2500, kSamples = 6000;
  unit.run(kSamples, [&](Frame frame) {
    const auto at = static_cast<int>(frame.interval) - kFrom;
    if (at >= 0 && at < unseen) frame[SignalKind::kMv].quality[1] = Quality::kBad;
    monitor.push(frame);
    for (const AlarmTransition& moved : monitor.transitions())
      if (moved.to == AlarmState::kActive && !(moved.cv == 0 && moved.input == 1))
        result.wrong += std::to_string(moved.cv) + std::to_string(moved.input) + ' ';
    if (at == unseen - 1 && unseen > 100)
      result.told = monitor.channel(0, 0).reason == Reason::kBadData &&
                    monitor.channel(0, 1).reason == Reason::kBadData;
  });
  result.found = monitor.alarm(0, 1) == AlarmState::kActive;
  result.used = monitor.counters().used;
  return result;
}

}  // namespace

TEST_CASE("what an unseen input does wrong is laid to no other one", "[trials]") {
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    for (const bool predictions : {true, false})
      for (const int unseen : {300, 1200}) {
        CAPTURE(seed, predictions, unseen);
        const Outcome seen = outcome(seed, predictions, unseen);
        CHECK(seen.wrong.empty());
        CHECK(seen.found);
        CHECK(seen.told);
      }
}

TEST_CASE(
    "rows wait while an input is not seen and until the plant has settled; a few may be held") {
  const std::uint64_t all = outcome(1, true, 0, 1.0).used;
  CHECK(outcome(1, true, 20, 1.0).used == all);
  // Both CVs: 300 and then some four time constants of 15 samples and the dead time.
  const std::uint64_t lost = all - outcome(1, true, 300, 1.0).used;
  CHECK(lost > 300 + 3 * 15);
  CHECK(lost < 300 + 10 * 15);
}

}  // namespace mpm::unseen_inputs_test
