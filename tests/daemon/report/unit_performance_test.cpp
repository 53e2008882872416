#include "daemon/report/unit_performance.hpp"

#include <catch2/catch.hpp>

#include "config/load_unit.hpp"
#include "daemon/report/unit_monitor.hpp"

namespace mpm::report {
namespace {

config::UnitConfig unit_of(const std::string& model) {
  const config::LoadResult loaded = config::load_unit_text(
      "unit: u\nsample_time: 2\nsignals: {mv: [{tag: u1, low: 0}, u2], cv: "
      "[{tag: y1, setpoint: sp1}, {tag: y2, prediction: p2}]}\n" +
          model +
          "simulation: {limits: {u1: {low: -9, high: 9}, u2: {high: "
          "7}, y1: {low: 1, high: 2}}}\n",
      "u.yaml");
  REQUIRE(loaded.ok());
  return loaded.config;
}

TEST_CASE("the horizons of a unit are those of its slowest channel, in either form of model") {
  using Horizons = std::vector<std::int64_t>;
  // 3 x 20 s + 4 s of dead time are 32 samples.
  const std::string channels =
      "model: {channels: [{cv: y1, mv: u1, gain: 1, time_constants: [20], dead_time: 4}, {cv: y2, "
      "mv: u2, gain: 2, time_constants: [5]}]}\n";
  CHECK(performance_setup(unit_of(channels)).horizons == Horizons{1, 16, 32, 64});
  // The pole is that of 20 s, exp(-2 / 20); sampled responses know it to a tenth.
  const Horizons found =
      performance_setup(unit_of("model: {state_space: {A: [[0.9048374]], B: [[1, 0]], C: [[1], "
                                "[0]], D: [[0, 0], [0, 0]]}}\n"))
          .horizons;
  REQUIRE(found.size() == 4);
  CHECK(std::abs(found[2] - 30) <= 3);
  // Days long: as far as memory shall go.
  CHECK(performance_setup(unit_of("model: {channels: [{cv: y1, mv: u1, gain: 1, time_constants: "
                                  "[200000]}, {cv: y2, mv: u2, gain: 1}]}\n"))
            .horizons == Horizons{1, calibration::performance::kLongestHorizon});
}

TEST_CASE("limits beside a signal count, else those of the simulation") {
  const PerformanceSetup setup = performance_setup(
      unit_of("model: {channels: [{cv: y1, mv: u1, gain: 1}, {cv: y2, mv: u2, gain: 1}]}\n"));
  CHECK(setup.mv_limits[0].low == 0.0);
  CHECK_FALSE(setup.mv_limits[0].high);
  CHECK_FALSE(setup.mv_limits[1].low);
  CHECK(setup.mv_limits[1].high == 7.0);
  CHECK(setup.cv_limits[0].high == 2.0);
  CHECK_FALSE(setup.cv_limits[1].known());
}

TEST_CASE("before any sample nothing is told, and shares of one limit are of that one") {
  const config::UnitConfig unit =
      unit_of("model: {channels: [{cv: y1, mv: u1, gain: 1}, {cv: y2, mv: u2, gain: 1}]}\n");
  PerformanceTally tally(unit);
  const PerformanceRecord none = tally.record();
  CHECK(std::isnan(none.service_factor));
  CHECK(std::isnan(none.mvs[0].at_low));
  CHECK(std::isnan(none.cvs[0].outside_limits));
  CHECK_FALSE(none.cvs[0].control_error.known());

  UnitMonitor monitor(unit);
  Frame frame(unit.counts());
  for (SignalBlock& block : frame.blocks)
    std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
  monitor.push(frame);
  tally.push(frame, monitor.monitor().judged());
  tally.push(frame, monitor.monitor().judged());  // not newer
  const PerformanceRecord one = tally.record();
  CHECK(one.samples == 1);
  CHECK(one.mvs[0].at_low == 1.0);  // it is 0
  CHECK(std::isnan(one.mvs[0].at_high));
  CHECK(one.mvs[0].at_limits == 1.0);
  CHECK(one.cvs[0].outside_limits == 1.0);  // below 1
  CHECK(std::isnan(one.cvs[1].outside_limits));
  CHECK_FALSE(one.cvs[1].setpoint);
  const nlohmann::ordered_json json = performance_json(one);
  CHECK_FALSE(json.contains("unit"));
  CHECK_FALSE(json.contains("window_samples"));
  CHECK(json["cvs"][0]["setpoint"] == "sp1");
  CHECK(json["cvs"][0]["control_error"]["mean"] == 0.0);
}

}  // namespace
}  // namespace mpm::report
