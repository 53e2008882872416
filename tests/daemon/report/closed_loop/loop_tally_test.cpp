#include "daemon/report/closed_loop/loop_tally.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "config/load_unit.hpp"

namespace mpm::test::loop_tally_test {
namespace {

config::UnitConfig unit() {
  const config::LoadResult loaded = config::load_unit_text(
      "unit: t\nsample_time: 1\nsignals: {mv: [u, v], cv: {tag: y, setpoint: sp}}\n"
      "model:\n  channels: [{cv: y, mv: u, gain: 1}, {cv: y, mv: v, gain: 1}]\n"
      "  operating_point: {u: 10}\n"
      "simulation: {limits: {u: {low: 0, high: 20}, v: {high: 4}}}\n",
      "t.yaml");
  REQUIRE(loaded.ok());
  return loaded.config;
}

Frame frame(const config::UnitConfig& config, double u, double v, double y, double setpoint) {
  Frame result(config.counts());
  const auto put = [&](SignalKind kind, int index, double value) {
    result[kind].values(index) = value;
    result[kind].quality[static_cast<std::size_t>(index)] =
        std::isfinite(value) ? Quality::kGood : Quality::kBad;
  };
  put(SignalKind::kMv, 0, u);
  put(SignalKind::kMv, 1, v);
  put(SignalKind::kCv, 0, y);
  put(SignalKind::kSetpoint, 0, setpoint);
  return result;
}

TEST_CASE("a loop's errors and its time at limits are counted, what is bad left out") {
  const config::UnitConfig config = unit();
  report::LoopTally tally(config, report::limits_in(config, {}));
  CHECK(std::isnan(tally.error_variance(0)));
  tally.add(frame(config, 20.0, 4.0, 1.0, 2.0));
  tally.add(frame(config, 0.0, 3.9, 3.0, 2.0));
  tally.add(frame(config, 5.0, std::nan(""), std::nan(""), 2.0));
  CHECK(tally.error_variance(0) == 1.0);
  CHECK(tally.at_limit(0) == Approx(2.0 / 3.0));
  CHECK(tally.at_limit(1) == 0.5);
}

TEST_CASE("a scenario's limits replace the unit file's") {
  config::ScenarioConfig scenario;
  scenario.mv_limits = {{"u", 0.5, {}, {}, {}}, {"v", 1.0, {}, 3.0, {}}};
  const std::vector<config::MvLimits> limits = report::limits_in(unit(), scenario);
  CHECK(limits[0].low == 5.0);
  CHECK(limits[0].high == 15.0);
  CHECK(limits[1].high == 3.0);
}

}  // namespace
}  // namespace mpm::test::loop_tally_test
