#include <catch2/catch.hpp>

#include "config/load_unit.hpp"
#include "config/scenario_config.hpp"

using namespace mpm::config;

namespace {

UnitConfig unit() {
  return load_unit_text(
             "unit: t\nsample_time: 1\nsignals: {mv: [u1, u2], dv: d1, cv: [y1, y2]}\n"
             "model:\n"
             "  channels:\n"
             "    - {cv: y1, mv: u1, gain: 2, dead_time: 3}\n"
             "    - {cv: y2, mv: u2, gain: 2}\n"
             "    - {cv: y2, mv: d1, gain: 2}\n",
             "u.yaml")
      .config;
}

ScenarioResult load(const std::string& text) {
  return load_scenario_text(text, "folder/s.yaml", unit());
}

}  // namespace

TEST_CASE("Every key of a scenario arrives") {
  const ScenarioResult result = load(
      "scenario: many\n"
      "description: all keys\n"
      "changes:\n"
      "  - {cv: y1, mv: u1, gain_ratio: 0.75, from: 100}\n"
      "  - {mv: d1, time_constant_ratio: 2}\n"
      "  - {dead_time_error: 4}\n"
      "draw: {gain_ratio: [0.6, 1.4], time_constant_ratio: 2, dead_time_error: [-1], from: 5, "
      "count: 2}\n"
      "noise: [{cv: y2, sigma_ratio: 3, from: 7}, {sigma_ratio: 0}]\n"
      "setpoints: {amplitude_ratio: 2, constant: true}\n"
      "controller: {integral_action: false, disturbance_feedback: 0.5, allow_unstable: true}\n"
      "limits: {u2: {low: -1.5, high: 1.5}, y1: {high: 4}}\n"
      "monitor: {correlation: alternative, threshold: mean_line, controlling_lags: 5}\n");
  for (const Finding& finding : result.findings) FAIL_CHECK(format(finding));
  const ScenarioConfig& scenario = result.scenario;
  CHECK(scenario.name == "many");
  CHECK(scenario.description == "all keys");
  REQUIRE(scenario.changes.size() == 3);
  CHECK(scenario.changes[0].cv == "y1");
  CHECK(scenario.changes[0].mv == "u1");
  CHECK(scenario.changes[0].gain_ratio == 0.75);
  CHECK(scenario.changes[0].from_s == 100);
  CHECK_FALSE(scenario.changes[1].cv);
  CHECK(scenario.changes[1].mv == "d1");
  CHECK(scenario.changes[1].time_constant_ratio == 2);
  CHECK(scenario.changes[2].dead_time_error_s == 4);
  REQUIRE(scenario.draw);
  CHECK(scenario.draw->gain_ratios == std::vector<double>{0.6, 1.4});
  CHECK(scenario.draw->time_constant_ratios == std::vector<double>{2});
  CHECK(scenario.draw->dead_time_errors_s == std::vector<double>{-1});
  CHECK(scenario.draw->from_s == 5);
  CHECK(scenario.draw->count == 2);
  REQUIRE(scenario.noise.size() == 2);
  CHECK(scenario.noise[0].cv == "y2");
  CHECK(scenario.noise[0].sigma_ratio == 3);
  CHECK(scenario.noise[0].from_s == 7);
  CHECK_FALSE(scenario.noise[1].cv);
  CHECK(scenario.setpoint_amplitude_ratio == 2.0);
  CHECK(scenario.constant_setpoints);
  CHECK_FALSE(scenario.integral_action);
  CHECK(scenario.disturbance_feedback == 0.5);
  CHECK(scenario.allow_unstable);
  REQUIRE(scenario.mv_limits.size() == 2);
  CHECK(scenario.mv_limits[1].low == -1.5);
  CHECK(scenario.mv_limits[1].high == 1.5);
  CHECK(scenario.cv_limits.at(0).high == 4.0);
  CHECK(scenario.monitor.correlation == mpm::CorrelationKind::kAlternative);
  CHECK(scenario.monitor.threshold == mpm::ThresholdKind::kMeanLine);
  CHECK(scenario.monitor.controlling_lags == 5);
}

TEST_CASE("What a scenario says of limits and monitor goes over the unit's, the rest stays") {
  UnitConfig own = unit();
  own.monitor.memory_s = 77.0;
  own.monitor.controlling_lags = 12;
  own.simulation.mv_limits[0] = {-5.0, 5.0, 1.0};
  own.simulation.cv_limits[1] = {-3.0, 3.0};
  const ScenarioResult result = load_scenario_text(
      "limits: {u1: {high: 2}}\nmonitor: {correlation: partial, controlling_lags: 40}\n", "s.yaml",
      own);
  for (const Finding& finding : result.findings) FAIL_CHECK(format(finding));
  CHECK(result.scenario.mv_limits.at(0).low == -5.0);
  CHECK(result.scenario.mv_limits.at(0).high == 2.0);
  CHECK(result.scenario.mv_limits.at(0).max_move == 1.0);
  CHECK_FALSE(result.scenario.mv_limits.at(1).low);
  CHECK(result.scenario.cv_limits.at(1).high == 3.0);
  CHECK(result.scenario.monitor.memory_s == 77.0);
  CHECK(result.scenario.monitor.controlling_lags == 40);
  CHECK(result.scenario.monitor.correlation == mpm::CorrelationKind::kPartial);
  CHECK(result.scenario.monitor.threshold == mpm::ThresholdKind::kFTest);

  const ScenarioResult silent = load_scenario_text("{}\n", "s.yaml", own);
  CHECK(silent.scenario.mv_limits.empty());
  CHECK(silent.scenario.monitor.memory_s == 77.0);
  CHECK(silent.scenario.monitor.controlling_lags == 12);
}

TEST_CASE("Lists of tags stand for one change each") {
  const ScenarioResult result = load("changes: [{cv: [y1, y2], gain_ratio: 2}]\n");
  CHECK(result.findings.empty());
  REQUIRE(result.scenario.changes.size() == 2);
  CHECK(result.scenario.changes[0].cv == "y1");
  CHECK(result.scenario.changes[1].cv == "y2");
  CHECK(result.scenario.name == "s");  // of the file, where none is given
}

TEST_CASE("Every mistake in a scenario is told at its place") {
  struct Case {
    std::string text, finding;
  };
  const auto [text, finding] = GENERATE(values<Case>({
      {"chnges: []\n", "folder/s.yaml:1:1: error: chnges: unknown key (did you mean 'changes'?)"},
      {"changes: [{cv: y3, gain_ratio: 2}]\n",
       "folder/s.yaml:1:16: error: changes[0].cv: 'y3' is no cv of this unit (did you mean "
       "'y1'?)"},
      {"changes: [{mv: y1, gain_ratio: 2}]\n",
       "folder/s.yaml:1:16: error: changes[0].mv: 'y1' is no mv or dv of this unit (did you mean "
       "'u1'?)"},
      {"changes: [{cv: y2, mv: u1, gain_ratio: 2}]\n",
       "folder/s.yaml:1:11: error: changes[0]: the model has no channel u1 -> y2"},
      {"changes: [{mv: u1}]\n",
       "folder/s.yaml:1:11: error: changes[0]: changes nothing: give gain_ratio, "
       "time_constant_ratio or dead_time_error"},
      {"changes: [{mv: u1, time_constant_ratio: 0}]\n",
       "folder/s.yaml:1:41: error: changes[0].time_constant_ratio: must be > 0, not 0"},
      {"changes: [{mv: u1, dead_time_error: -4}]\n",
       "folder/s.yaml:1:11: error: changes[0]: dead_time_error -4 makes the dead time of u1 -> y1 "
       "negative (model: 3 s)"},
      {"changes: [{mv: u1, gain_ratio: 2, from: -1}]\n",
       "folder/s.yaml:1:41: error: changes[0].from: must be >= 0, not -1"},
      {"draw: {count: 2}\n",
       "folder/s.yaml:1:7: error: draw: draws nothing: give gain_ratio, time_constant_ratio or "
       "dead_time_error"},
      {"draw: {gain_ratio: 2, count: 4}\n",
       "folder/s.yaml:1:30: error: draw.count: must be >= 1 and <= 3, not 4"},
      {"noise: [{cv: y1}]\n", "folder/s.yaml:1:9: error: noise[0]: `sigma_ratio` is missing"},
      {"setpoints: {constant: maybe}\n",
       "folder/s.yaml:1:23: error: setpoints.constant: must be true or false, not 'maybe'"},
      {"controller: {disturbance_feedback: 2}\n",
       "folder/s.yaml:1:36: error: controller.disturbance_feedback: must be >= 0 and <= 1, not 2"},
      {"controller: {allow_unstable: 1}\n",
       "folder/s.yaml:1:30: error: controller.allow_unstable: must be true or false, not '1'"},
      {"limits: {u3: {low: 1}}\n",
       "folder/s.yaml:1:10: error: limits.u3: unknown mv or cv (did you mean 'u1'?)"},
      {"limits: {u1: {low: 2, high: 1}}\n",
       "folder/s.yaml:1:29: error: limits.u1.high: must be above low"},
      {"monitor: {controling_lags: 5}\n",
       "folder/s.yaml:1:11: error: monitor.controling_lags: unknown key (did you mean "
       "'controlling_lags'?)"},
      {"monitor: {controlling_lags: 0}\n",
       "folder/s.yaml:1:29: error: monitor.controlling_lags: must be >= 1 and <= 10000, not 0"},
      {"monitor: {correlation: lagged}\n",
       "folder/s.yaml:1:24: error: monitor.correlation: must be one of lagged_partial, partial, "
       "conventional, alternative, not 'lagged'"},
      {"monitor: {threshold: [f_test]}\n",
       "folder/s.yaml:1:22: error: monitor.threshold: must be a text, not a list"},
      {"monitor: {first_lag: 21}\n",
       "folder/s.yaml:1:22: error: monitor.first_lag: first_lag must not be above last_lag"},
      {"monitor: {memory: 1}\n",
       "folder/s.yaml:1:19: error: monitor.memory: must be longer than the sample time"},
      {"none\n",
       "folder/s.yaml:1:1: error: a scenario is a map of keys such as `scenario:` and "
       "`changes:`"},
  }));
  CAPTURE(text);
  const ScenarioResult result = load(text);
  REQUIRE(result.findings.size() == 1);
  CHECK(format(result.findings[0]) == finding);
}

TEST_CASE("A scenario is found by name or path") {
  CHECK(find_scenario("my/own.yaml", "nowhere.yaml") == "my/own.yaml");
  CHECK_THAT(find_scenario("s3_delay", "nowhere.yaml"),
             Catch::Matchers::EndsWith("/config/scenarios/s3_delay.yaml"));
  CHECK_THROWS_WITH(find_scenario("s3_dely", "nowhere.yaml"),
                    Catch::Matchers::StartsWith(
                        "error: unknown scenario 's3_dely' (did you mean 's3_delay'?); known: "));
  CHECK_THROWS_WITH(find_scenario("", "nowhere.yaml"),
                    Catch::Matchers::StartsWith("error: unknown scenario '' (known: "));
}
