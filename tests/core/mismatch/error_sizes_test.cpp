#include "core/mismatch/error_sizes.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <ostream>

#include "core/monitor/monitor.hpp"
#include "tests/core/open_loop_unit.hpp"

namespace mpm::error_sizes_test {
namespace {

/// What is wrong with the channel.
struct Hidden {
  double gain_ratio = 1.0, time_constant_ratio = 1.0, dead_time = 0.0;  ///< the latter in samples
};

std::ostream& operator<<(std::ostream& out, const Hidden& hidden) {
  return out << "gain x" << hidden.gain_ratio << ", time constant x" << hidden.time_constant_ratio
             << ", dead time +" << hidden.dead_time;
}

ChannelStatus monitored(const Hidden& hidden, std::uint64_t seed, bool integrating = false) {
  test::OpenLoopUnit unit;
  unit.channel().dead_time_s = 4.0;  // so that there is something to take off
  if (integrating) {
    unit.channel().integrating = true;
    unit.channel().gain = -0.05;  // per second
  }
  unit.gain_ratio = hidden.gain_ratio;
  unit.time_constant_ratio = hidden.time_constant_ratio;
  unit.later = hidden.dead_time;
  unit.seed = seed;
  Monitor monitor(unit.model, unit.counts, {true, true}, {}, {});
  unit.run(1300, [&](const Frame& frame) { monitor.push(frame); });
  return monitor.channel(0, 1);
}

bool holds(const Estimate& estimate, double truth) {
  return std::abs(estimate.value - truth) < 1.96 * estimate.deviation;
}

// 95 % intervals of 15 seeds miss the truth five times or more in 1 of 1600 tries. As long as the
// errors were taken for small ones, those of a time constant that is twice as long, or of a dead
// time that is 3 samples longer, held the truth in none.
TEST_CASE("the intervals of a gain, a time constant and a dead time hold the truth, small or large",
          "[trials]") {
  for (const Hidden& hidden :
       {Hidden{1.05, 1.0, 0.0}, Hidden{1.3, 1.0, 0.0}, Hidden{2.0, 1.0, 0.0}, Hidden{0.4, 1.0, 0.0},
        Hidden{1.0, 1.5, 0.0}, Hidden{1.0, 2.0, 0.0}, Hidden{1.0, 0.5, 0.0}, Hidden{1.0, 1.0, 3.0},
        Hidden{1.0, 1.0, 6.0}, Hidden{1.0, 1.0, -3.0}, Hidden{1.4, 1.5, 2.0}}) {
    CAPTURE(hidden);
    int gain = 0, time = 0, dead = 0, unusual = 0;
    for (std::uint64_t seed = 1; seed <= 15; ++seed) {
      const ChannelStatus status = monitored(hidden, seed);
      unusual += status.usual ? 0 : 1;
      const double truth = 1.0 - hidden.gain_ratio;  // of a gain of -1
      gain += status.effect_low < truth && truth < status.effect_high ? 0 : 1;
      time += holds(status.log_time_error, std::log(hidden.time_constant_ratio)) ? 0 : 1;
      dead += holds(status.dead_time_error, hidden.dead_time) ? 0 : 1;
    }
    CHECK(unusual <= 1);
    CHECK(gain <= 4);
    CHECK(time <= 4);
    CHECK(dead <= 4);
  }
}

// What makes an integrator rise later is its lag and its dead time, which the data hardly tell
// apart; how steeply it rises is its gain alone. While a longer lag was taken to make it less
// steep, a gain error of 40 % was seen beyond all doubt and passed for one that may not matter.
TEST_CASE("the gain of an integrating channel is told from its lag and its dead time", "[trials]") {
  for (const Hidden& hidden : {Hidden{1.4, 1.0, 0.0}, Hidden{0.6, 1.0, 0.0}, Hidden{1.0, 2.0, 0.0},
                               Hidden{1.0, 1.0, 3.0}}) {
    CAPTURE(hidden);
    int gain = 0, wide = 0, doubtful = 0;
    for (std::uint64_t seed = 1; seed <= 15; ++seed) {
      const ChannelStatus status = monitored(hidden, seed, true);
      const double low = status.effect_low / std::abs(status.model_gain);
      const double high = status.effect_high / std::abs(status.model_gain);
      const double truth = 1.0 - hidden.gain_ratio;  // of a negative gain
      gain += low < truth && truth < high ? 0 : 1;
      wide += high - low < 0.3 ? 0 : 1;
      doubtful += status.p_value_material < 1e-6 ? 0 : 1;
    }
    CHECK(gain <= 4);
    CHECK(wide == 0);
    if (hidden.gain_ratio != 1.0) CHECK(doubtful == 0);
  }
}

}  // namespace
}  // namespace mpm::error_sizes_test
