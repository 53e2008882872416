#include "sim/plant/recovery_boiler/boiler_process.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "config/load_unit.hpp"
#include "sim/loop/closed_loop.hpp"
#include "sim/scenario/prepare.hpp"
#include "tests/sim/units.hpp"

namespace mpm::sim::boiler {
namespace {

LoopSetup setup_of(const std::vector<config::ProcessChange>& changes) {
  LoopSetup setup = test::healthy_loop(test::load_plant("recovery_boiler"), 1);
  setup.scenario.process = changes;
  return setup;
}

/// Mean of a CV over the second half of so many samples.
double mean_of(ClosedLoop& loop, Eigen::Index cv, int samples) {
  double sum = 0.0, count = 0.0;
  for (int k = 0; k < samples; ++k) {
    const Frame& frame = loop.step();
    if (2 * k >= samples) sum += frame[SignalKind::kCv].values(cv), count += 1.0;
  }
  return sum / count;
}

TEST_CASE("the boiler stands behind its unit, with what it measures beside") {
  ClosedLoop loop(setup_of({}));
  const Frame& first = loop.step();
  CHECK(first[SignalKind::kCv].values(0) == Approx(389.0).margin(3.0));
  CHECK(first[SignalKind::kCv].values(3) == Approx(272.0).margin(5.0));
  CHECK(first[SignalKind::kAux].values(3) == Approx(30.0));
  CHECK(first[SignalKind::kAux].values(4) == Approx(65.0));
  for (int k = 0; k < 300; ++k) {
    const Frame& frame = loop.step();
    REQUIRE(loop.finite());
    CHECK(frame[SignalKind::kMv].values(0) >= 15.0);
    CHECK(frame[SignalKind::kMv].values(0) <= 45.0);
  }
}

TEST_CASE("the same seed gives the same boiler, another one another") {
  const auto last = [](std::uint64_t seed) {
    LoopSetup setup = setup_of({});
    setup.seed = seed;
    ClosedLoop loop(setup);
    for (int k = 0; k < 99; ++k) static_cast<void>(loop.step());
    return loop.step()[SignalKind::kCv].values;
  };
  CHECK(last(3) == last(3));
  CHECK(last(3) != last(4));
}

TEST_CASE("what a scenario changes in the boiler lasts from its time to its end") {
  config::ProcessChange change;
  change.quantity = "o2_offset";
  change.value = 5.0;
  change.from_s = 500.0;
  change.until_s = 1000.0;
  LoopSetup setup = setup_of({change});
  setup.scenario.controller_off = {{0.0, config::kForEver}};
  ClosedLoop loop(setup);
  for (int k = 0; k < 120; ++k) {
    const double o2 = loop.step()[SignalKind::kCv].values(2);
    CHECK((o2 > 8.0) == (k > 50 && k <= 100));
  }
}

TEST_CASE("a quicker oxidation of CO shows where the controller is off") {
  config::ProcessChange change;
  change.quantity = "co_oxidation";
  change.value = 1.1;
  LoopSetup changed = setup_of({change}), usual = setup_of({});
  changed.scenario.controller_off = usual.scenario.controller_off = {{0.0, config::kForEver}};
  ClosedLoop one(changed), other(usual);
  CHECK(mean_of(one, 3, 200) < 0.95 * mean_of(other, 3, 200));
}

TEST_CASE("every scenario of the boiler runs on it") {
  const std::string folder = std::string(MPM_SOURCE_DIR) + "/config/plants/scenarios";
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    CAPTURE(entry.path());
    LoopSetup setup = setup_of({});
    config::ScenarioResult loaded =
        config::load_scenario(entry.path().string(), setup.unit, 2000.0);
    for (const config::Finding& finding : loaded.findings) FAIL_CHECK(config::format(finding));
    setup.scenario = std::move(loaded.scenario);
    hide_changes(setup);
    ClosedLoop loop(setup);
    for (int k = 0; k < 200; ++k) static_cast<void>(loop.step());
    CHECK(loop.finite());
    ++count;
  }
  CHECK(count == 8);
}

TEST_CASE("what is no boiler is refused") {
  config::UnitConfig unit = test::load_plant("recovery_boiler");
  unit.sample_time_s = 2.5;
  CHECK_THROWS_AS(BoilerProcess(unit, {}, 1), std::invalid_argument);
  unit = test::load_plant("shell3x3");
  CHECK_THROWS_AS(BoilerProcess(unit, {}, 1), std::invalid_argument);
  CHECK_THROWS_AS(ClosedLoop(setup_of({{"no_such", 1.0, 0.0, config::kForEver, {}}})),
                  std::invalid_argument);
}

}  // namespace
}  // namespace mpm::sim::boiler
