#include <catch2/catch.hpp>

#include "core/monitor/monitor.hpp"
#include "sim/output/bad_data.hpp"
#include "sim/scenario/prepare.hpp"
#include "tests/sim/units.hpp"

namespace bad_data_alarms_test {

namespace {

using mpm::AlarmState;
using mpm::Monitor;
using mpm::Reason;
using mpm::Verdict;

struct Outcome {
  int alarms = 0;
  int mismatches = 0;
  int bad_data = 0;  // verdicts of that reason
  mpm::MonitorCounters counters;
  bool found = false;  // an alarm stands on u3 -> y2
};

// Shell 3 x 3 with its reported data spoiled; `gain_ratio` of u3 -> y2 in the plant.
Outcome run(const std::string& bad_data, std::uint64_t seed, double gain_ratio = 1.0) {
  mpm::sim::LoopSetup setup = mpm::test::healthy_loop(mpm::test::load_plant("shell3x3"), seed);
  setup.samples = 3000;
  if (gain_ratio != 1.0) setup.scenario.changes = {mpm::test::gain_change("y2", "u3", gain_ratio)};
  for (const auto& finding :
       mpm::config::add_bad_data(bad_data, setup.unit, 3000.0, setup.scenario))
    FAIL(format(finding));
  mpm::sim::hide_changes(setup);
  mpm::sim::ClosedLoop loop(setup);
  mpm::sim::BadDataFilter filter(setup);
  Monitor monitor(setup.unit.model, setup.unit.counts(), {true, true, true}, {}, {});
  Outcome outcome;
  for (int k = 0; k < 3000; ++k) {
    const mpm::Frame* reported = filter.apply(loop.step());
    if (reported == nullptr) continue;
    monitor.push(*reported);
    for (const mpm::AlarmTransition& change : monitor.transitions())
      outcome.alarms += change.to == AlarmState::kActive ? 1 : 0;
  }
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      outcome.mismatches += monitor.channel(j, i).verdict == Verdict::kMismatch ? 1 : 0;
      outcome.bad_data += monitor.channel(j, i).reason == Reason::kBadData ? 1 : 0;
    }
  outcome.counters = monitor.counters();
  outcome.found = monitor.alarm(1, 2) == AlarmState::kActive;
  return outcome;
}

}  // namespace

TEST_CASE("no alarm comes of bad data") {
  // Healthy units; seeds of their own. What each kind does to the verdicts is in
  // docs/validation.md.
  const std::string kind = GENERATE("missing", "uncertain", "gaps", "frozen", "spikes", "clipping");
  const std::string share = GENERATE("1%", "5%", "20%");
  for (std::uint64_t seed = 7001; seed <= 7003; ++seed) {
    const Outcome outcome = run(kind + "=" + share, seed);
    CAPTURE(kind, share, seed);
    CHECK(outcome.alarms == 0);
    if (kind == "missing") CHECK(outcome.counters.bad_values > 0);
    if (kind == "gaps") CHECK(outcome.counters.missing > 0);
    if (kind == "frozen") CHECK(outcome.counters.implausible.frozen > 0);
    if (kind == "clipping") CHECK(outcome.counters.implausible.clipped > 0);
    if (kind == "spikes") CHECK(outcome.counters.implausible.spikes > 0);
    // So much falsified is said to be too much.
    if (share == "20%" && (kind == "frozen" || kind == "clipping")) CHECK(outcome.bad_data == 9);
  }
}

TEST_CASE("a wrong gain is found behind a twentieth of bad data") {
  for (const std::string kind : {"missing", "uncertain", "gaps", "frozen", "clipping"}) {
    for (std::uint64_t seed = 7011; seed <= 7013; ++seed) {
      CAPTURE(kind, seed);
      const Outcome outcome = run(kind + "=5%", seed, 0.7);
      CHECK(outcome.found);
      CHECK(outcome.alarms == 1);
    }
  }
}

}  // namespace bad_data_alarms_test
