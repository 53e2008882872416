#include <catch2/catch.hpp>

#include "core/monitor/monitor.hpp"
#include "tests/core/open_loop_unit.hpp"

namespace mpm {
namespace {

constexpr int kTimeConstant = 150;  // samples, the slowest
constexpr int kBefore = 60;         // samples that the monitor has not seen

// Predictions are simulated, from a start amid a move.
struct Start {
  bool alarmed_wrongly = false, found = false, begun = false;
};

Start start(std::uint64_t seed, double gain_ratio, int samples) {
  test::OpenLoopUnit unit;
  unit.seed = seed;
  unit.gain_ratio = gain_ratio;
  std::get<TransferFunction>(unit.model.channels[0].dynamics).time_constants_s = {kTimeConstant};
  unit.channel().time_constants_s = {kTimeConstant / 2.0};
  Monitor monitor(unit.model, unit.counts, {false, false}, {}, {});
  Start result;
  unit.run(kBefore + samples, [&](const Frame& frame) {
    if (frame.interval < kBefore) return;
    monitor.push(frame);
    for (const AlarmTransition& change : monitor.transitions()) {
      const bool wrong = gain_ratio == 1.0 || change.cv != 0 || change.input != 1;
      result.alarmed_wrongly = result.alarmed_wrongly || wrong;
    }
  });
  const ChannelStatus& channel = monitor.channel(0, 1);
  result.begun = channel.reason != Reason::kWarmingUp;
  result.found = channel.verdict == Verdict::kMismatch;
  return result;
}

TEST_CASE("a simulation that begins amid a move is judged before it has forgotten its start") {
  // Expected: what was put in. Five slowest time constants would be the end of these data.
  constexpr int kSamples = 5 * kTimeConstant;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    CAPTURE(seed);
    const Start healthy = start(seed, 1.0, kSamples);
    CHECK(healthy.begun);
    CHECK_FALSE(healthy.found);
    CHECK_FALSE(healthy.alarmed_wrongly);
    const Start wrong = start(seed, 0.6, kSamples);
    CHECK(wrong.found);
    CHECK_FALSE(wrong.alarmed_wrongly);
  }
}

TEST_CASE("a channel slower than all that is remembered blinds no other") {
  test::OpenLoopUnit unit;
  unit.gain_ratio = 0.6;
  std::get<TransferFunction>(unit.model.channels[3].dynamics).time_constants_s = {1e7};
  Monitor monitor(unit.model, unit.counts, {false, false}, {}, {});
  unit.run(4000, [&](const Frame& frame) { monitor.push(frame); });
  CHECK(monitor.channel(0, 0).verdict == Verdict::kMatch);
  CHECK(monitor.channel(0, 1).verdict == Verdict::kMismatch);
}

}  // namespace
}  // namespace mpm
