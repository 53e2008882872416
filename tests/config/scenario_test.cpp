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
             "    - {cv: y2, mv: d1, gain: 2}\n"
             "simulation: {}\n",
             "u.yaml")
      .config;
}

ScenarioResult load(const std::string& text) {
  return load_scenario_text(text, "folder/s.yaml", unit());
}

}  // namespace

TEST_CASE("tests of MVs and changes of a process arrive, and their mistakes are told") {
  UnitConfig boiler = unit();
  boiler.simulation.process = "recovery_boiler";
  const ScenarioResult result = load_scenario_text(
      "tests: [{mv: u1, size: 2, hold: 3 samples, random: false, from: 10, until: 20}]\n"
      "process: [{quantity: co_oxidation, value: 1.1, from: 5}]\n",
      "s.yaml", boiler);
  CHECK(result.findings.empty());
  REQUIRE(result.scenario.tests.size() == 1);
  CHECK(result.scenario.tests[0].mv == "u1");
  CHECK(result.scenario.tests[0].size == 2.0);
  CHECK(result.scenario.tests[0].hold_s == 3.0);
  CHECK_FALSE(result.scenario.tests[0].random);
  CHECK(result.scenario.tests[0].from_s == 10.0);
  CHECK(result.scenario.tests[0].until_s == 20.0);
  REQUIRE(result.scenario.process.size() == 1);
  CHECK(result.scenario.process[0].quantity == "co_oxidation");
  CHECK(result.scenario.process[0].value == 1.1);
  CHECK(result.scenario.process[0].from_s == 5.0);

  const ScenarioResult wrong = load(
      "tests: [{mv: d1, size: -1, hold: 1}]\nprocess: [{quantity: co_oxidation, value: 1.1}]\n");
  REQUIRE(wrong.findings.size() == 3);
  CHECK(format(wrong.findings[0]).find("'d1' is no mv") != std::string::npos);
  CHECK(format(wrong.findings[1]).find("size: must be > 0") != std::string::npos);
  CHECK(format(wrong.findings[2]).find("names no `simulation: process:`") != std::string::npos);
}

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
  CHECK(scenario.monitor.correlation == mpm::CorrelationKind::kAlternative);
  CHECK(scenario.monitor.threshold == mpm::ThresholdKind::kMeanLine);
  CHECK(scenario.monitor.controlling_lags == 5);
}

TEST_CASE("What a scenario says of the monitor goes over the unit's, the rest stays") {
  UnitConfig own = unit();
  own.monitor.memory_s = 77.0;
  own.monitor.controlling_lags = 12;
  const ScenarioResult result =
      load_scenario_text("monitor: {correlation: partial, controlling_lags: 40}\n", "s.yaml", own);
  for (const Finding& finding : result.findings) FAIL_CHECK(format(finding));
  CHECK(result.scenario.monitor.memory_s == 77.0);
  CHECK(result.scenario.monitor.controlling_lags == 40);
  CHECK(result.scenario.monitor.correlation == mpm::CorrelationKind::kPartial);
  CHECK(result.scenario.monitor.threshold == mpm::ThresholdKind::kFTest);

  const ScenarioResult silent = load_scenario_text("{}\n", "s.yaml", own);
  CHECK(silent.scenario.monitor.memory_s == 77.0);
  CHECK(silent.scenario.monitor.controlling_lags == 12);
}

TEST_CASE("Every key of disturbances, noise and the loop arrives, in seconds and CV units") {
  UnitConfig plant = unit();
  plant.sample_time_s = 2.0;
  plant.simulation.noise[1] = {0.03, 0.8};  // s.d. 0.03 / sqrt(1 - 0.64) = 0.05
  const ScenarioResult result = load_scenario_text(
      "changes: [{mv: 1, cv: 1, dead_time_error: -1 samples, from: 10 samples, until: 50%}]\n"
      "noise:\n"
      "  - {student_t: 2.5, from: 25 %, until: 75 %}\n"
      "  - {cv: 2, follows: y1, lag: 5, gain: 0.5}\n"
      "disturbances:\n"
      "  - {step: -2 sd, cv: y2, time_constant: 30, from: 5 samples, until: 100 s}\n"
      "  - {ramp: 0.5, cv: 1, duration: 50 %}\n"
      "  - {drift: 0.1, cv: 1, pole: 0.99}\n"
      "  - {periodic: 0.1, period: 70 samples, phase: 45, cv: [1, 2]}\n"
      "  - {sensor_noise: 0.1}\n"
      "setpoints: {equal: [y2, y1], moving: 2}\n"
      "controller:\n"
      "  off: [{from: 10, until: 20}, {from: 90 %}]\n"
      "  mv_limits: [{mv: u1, ratio: 0.5}, {mv: 2, low: -1, high: 2, max_move: 0.1}]\n",
      "s.yaml", plant, 1000.0);
  for (const Finding& finding : result.findings) FAIL_CHECK(format(finding));
  const ScenarioConfig& scenario = result.scenario;
  REQUIRE(scenario.changes.size() == 1);
  CHECK(scenario.changes[0].cv == "y1");
  CHECK(scenario.changes[0].mv == "u1");
  CHECK(scenario.changes[0].dead_time_error_s == -2.0);
  CHECK(scenario.changes[0].from_s == 20.0);
  CHECK(scenario.changes[0].until_s == 500.0);
  CHECK(scenario.changes[0].place.file == "s.yaml");
  CHECK(scenario.changes[0].place.line == 1);
  CHECK(scenario.changes[0].place.column == 11);
  CHECK(scenario.changes[0].place.key == "changes[0]");
  REQUIRE(scenario.noise.size() == 2);
  CHECK_FALSE(scenario.noise[0].cv);
  CHECK(scenario.noise[0].student_t == 2.5);
  CHECK(scenario.noise[0].from_s == 250.0);
  CHECK(scenario.noise[0].until_s == 750.0);
  CHECK(scenario.noise[1].cv == "y2");
  CHECK(scenario.noise[1].follows == "y1");
  CHECK(scenario.noise[1].lag_samples == 5);
  CHECK(scenario.noise[1].gain == 0.5);
  const std::vector<Disturbance>& shapes = scenario.disturbances;
  REQUIRE(shapes.size() == 7);
  CHECK(shapes[0].kind == DisturbanceKind::kStep);
  CHECK(shapes[0].cv == "y2");
  CHECK(shapes[0].size == Approx(-0.1));
  CHECK(shapes[0].time_constant_s == 30.0);
  CHECK(shapes[0].from_s == 10.0);
  CHECK(shapes[0].until_s == 100.0);
  CHECK(shapes[1].kind == DisturbanceKind::kRamp);
  CHECK(shapes[1].duration_s == 500.0);
  CHECK(shapes[1].until_s == kForEver);
  CHECK(shapes[2].pole == 0.99);
  CHECK(shapes[3].period_s == 140.0);
  CHECK(shapes[3].phase_degrees == 45.0);
  CHECK(shapes[4].cv == "y2");
  CHECK(shapes[5].kind == DisturbanceKind::kSensorNoise);
  CHECK(shapes[6].cv == "y2");
  CHECK(scenario.equal_setpoints == std::vector<std::string>{"y2", "y1"});
  REQUIRE(scenario.moving_setpoints);
  CHECK(*scenario.moving_setpoints == std::vector<std::string>{"y2"});
  REQUIRE(scenario.controller_off.size() == 2);
  CHECK(scenario.controller_off[0].until_s == 20.0);
  CHECK(scenario.controller_off[1].from_s == 900.0);
  REQUIRE(scenario.mv_limits.size() == 2);
  CHECK(scenario.mv_limits[0].ratio == 0.5);
  CHECK(scenario.mv_limits[1].mv == "u2");
  CHECK(scenario.mv_limits[1].low == -1.0);
  CHECK(scenario.mv_limits[1].high == 2.0);
  CHECK(scenario.mv_limits[1].max_move == 0.1);
}

TEST_CASE("Every kind of bad data arrives") {
  UnitConfig plant = unit();
  plant.simulation.noise = {{0.03, 0.8}, {0.06, 0.8}};  // s.d. 0.05 and 0.1
  const ScenarioResult result = load_scenario_text(
      "bad_data:\n"
      "  - {missing: 5 %, from: 10 %}\n"
      "  - {uncertain: 0.05, tags: [y1, d1]}\n"
      "  - {gaps: 1 %}\n"
      "  - {frozen: 20 %, run: 60, until: 500}\n"
      "  - {spikes: 1 %, size: 10 sd}\n"
      "  - {spikes: 1 %, size: 3, tags: u1}\n"
      "  - {spikes: 1 %}\n"
      "  - {clipping: 1 %}\n"
      "  - {clipping: range, low: -1, high: 2, tags: y1}\n"
      "  - {time_jitter: 20 %}\n"
      "  - {clock_steps: [3600, -2 samples], count: 3}\n",
      "s.yaml", plant, 1000.0);
  for (const Finding& finding : result.findings) FAIL_CHECK(format(finding));
  const std::vector<BadData>& bad = result.scenario.bad_data;
  REQUIRE(bad.size() == 11);
  const std::vector<std::string> measured = {"u1", "u2", "d1", "y1", "y2"};
  const std::vector<std::string> cvs = {"y1", "y2"};
  CHECK(bad[0].kind == BadDataKind::kMissing);
  CHECK(bad[0].share == 0.05);
  CHECK(bad[0].from_s == 100.0);
  CHECK(bad[0].tags == measured);
  CHECK(bad[0].run_samples == 0);
  CHECK(bad[1].tags == std::vector<std::string>{"y1", "d1"});
  CHECK(bad[2].tags.empty());
  CHECK(bad[2].run_samples == 10);
  CHECK(bad[3].run_samples == 60);
  CHECK(bad[3].until_s == 500.0);
  CHECK(bad[4].tags == cvs);
  REQUIRE(bad[4].sizes.size() == 2);
  CHECK(bad[4].sizes[0] == Approx(0.5));
  CHECK(bad[4].sizes[1] == Approx(1.0));
  CHECK(bad[5].sizes == std::vector<double>{3.0});
  CHECK(bad[6].sizes[1] == Approx(2.0));  // 20 sd
  CHECK(bad[7].tags == cvs);
  CHECK(bad[7].share == 0.01);
  CHECK(bad[8].low == -1.0);
  CHECK(bad[8].high == 2.0);
  CHECK(bad[9].share == 0.2);
  CHECK(bad[10].steps_s == std::vector<double>{3600.0, -2.0, 3600.0});

  ScenarioConfig scenario;
  CHECK(add_bad_data("frozen=5%,run=60", plant, 1000.0, scenario).empty());
  REQUIRE(scenario.bad_data.size() == 1);
  CHECK(scenario.bad_data[0].share == 0.05);
  CHECK(scenario.bad_data[0].run_samples == 60);
  const std::vector<Finding> wrong = add_bad_data("frozen=5%,rnu=60", plant, 1000.0, scenario);
  REQUIRE(wrong.size() == 1);
  CHECK(format(wrong[0]) == "--bad-data: error: rnu: unknown key of frozen (did you mean 'run'?)");
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
      {"noise: [{cv: y1}]\n",
       "folder/s.yaml:1:9: error: noise[0]: changes nothing: give sigma_ratio, student_t or "
       "follows"},
      {"noise: [{cv: y1, student_t: 2}]\n",
       "folder/s.yaml:1:29: error: noise[0].student_t: must be > 2 and <= 1000, not 2"},
      {"noise: [{cv: y1, follows: y1}]\n",
       "folder/s.yaml:1:27: error: noise[0].follows: a CV's noise cannot follow itself"},
      {"noise: [{sigma_ratio: 2, lag: 3}]\n",
       "folder/s.yaml:1:31: error: noise[0].lag: belongs to `follows`, the CV whose noise leads"},
      {"disturbances: [{cv: y1}]\n",
       "folder/s.yaml:1:16: error: disturbances[0]: give one of step, ramp, drift, periodic, "
       "sensor_noise"},
      {"disturbances: [{step: 1, period: 3}]\n",
       "folder/s.yaml:1:26: error: disturbances[0].period: unknown key of a step (known: cv, from, "
       "until, step, time_constant)"},
      {"disturbances: [{step: 1, cv: 3}]\n",
       "folder/s.yaml:1:30: error: disturbances[0].cv: '3' is no cv of this unit (known: y1, y2)"},
      {"disturbances: [{ramp: 1}]\n",
       "folder/s.yaml:1:16: error: disturbances[0]: `duration` is missing"},
      {"disturbances: [{step: 1, from: 50 %}]\n",
       "folder/s.yaml:1:32: error: disturbances[0].from: a share of the run, but the length of the "
       "run is not given (--samples)"},
      {"disturbances: [{step: 1, from: 10, until: 5}]\n",
       "folder/s.yaml:1:43: error: disturbances[0].until: must be after `from`"},
      {"disturbances: [{step: 1 sd, cv: y1}]\n",
       "folder/s.yaml:1:23: error: disturbances[0].step: the unit file gives y1 no noise: give the "
       "size in CV units"},
      {"disturbances: [{step: 3 days, cv: y1}]\n",
       "folder/s.yaml:1:23: error: disturbances[0].step: must be a number, not '3 days'"},
      {"bad_data: [{tags: y1}]\n",
       "folder/s.yaml:1:12: error: bad_data[0]: give one of missing, uncertain, gaps, frozen, "
       "spikes, clipping, time_jitter, clock_steps"},
      {"bad_data: [{missing: 5}]\n",
       "folder/s.yaml:1:22: error: bad_data[0].missing: must be a share from 0 to 100 %, such as "
       "0.05 or 5 %"},
      {"bad_data: [{time_jitter: 50 %}]\n",
       "folder/s.yaml:1:26: error: bad_data[0].time_jitter: must be a share from 0 to 50 %, such "
       "as 0.05 or 5 %"},
      {"bad_data: [{gaps: 1 %, tags: y1}]\n",
       "folder/s.yaml:1:24: error: bad_data[0].tags: unknown key of gaps (known: run, gaps, from, "
       "until)"},
      {"bad_data: [{spikes: 1 %, tags: u1, size: 3 sd}]\n",
       "folder/s.yaml:1:42: error: bad_data[0].size: standard deviations are known of CVs only: "
       "give u1 a size in its units"},
      {"bad_data: [{clipping: range}]\n",
       "folder/s.yaml:1:23: error: bad_data[0].clipping: give `low` or `high`, or a share of the "
       "samples"},
      {"bad_data: [{clock_steps: 5}]\n",
       "folder/s.yaml:1:26: error: bad_data[0].clock_steps: come at random times, but the length "
       "of the run is not given (--samples)"},
      {"setpoints: {equal: y1}\n",
       "folder/s.yaml:1:20: error: setpoints.equal: give two CVs or more"},
      {"controller: {mv_limits: {mv: u1, low: 2, high: 1}}\n",
       "folder/s.yaml:1:48: error: controller.mv_limits.high: must be above low"},
      {"setpoints: {constant: maybe}\n",
       "folder/s.yaml:1:23: error: setpoints.constant: must be true or false, not 'maybe'"},
      {"controller: {disturbance_feedback: 2}\n",
       "folder/s.yaml:1:36: error: controller.disturbance_feedback: must be >= 0 and <= 1, not 2"},
      {"controller: {allow_unstable: 1}\n",
       "folder/s.yaml:1:30: error: controller.allow_unstable: must be true or false, not '1'"},
      {"monitor: {controling_lags: 5}\n",
       "folder/s.yaml:1:11: error: monitor.controling_lags: unknown key (did you mean "
       "'controlling_lags'?)"},
      {"monitor: {controlling_lags: 0}\n",
       "folder/s.yaml:1:29: error: monitor.controlling_lags: must be >= 1 and <= 10000, not 0"},
      {"monitor: {correlation: lagged}\n",
       "folder/s.yaml:1:24: error: monitor.correlation: must be one of lagged_partial, partial, "
       "conventional, alternative, spearman, rank_partial, not 'lagged'"},
      {"monitor: {threshold: [f_test]}\n",
       "folder/s.yaml:1:22: error: monitor.threshold: must be a text, not a list"},
      {"monitor: {correlation: spearman, threshold: mean_line}\n",
       "folder/s.yaml:1:45: error: monitor.threshold: mean_line is no threshold of rank "
       "correlations"},
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
                    Catch::Matchers::StartsWith("error: unknown scenario ''; known: "));
}

TEST_CASE("What is hidden in the plant arrives") {
  const UnitConfig plant = load_unit_text(
                               "unit: t\nsample_time: 1\n"
                               "signals: {mv: [u1, u2], dv: d1, cv: [y1, y2], aux: [a1, a2]}\n"
                               "operating_point: {u1: 5, y1: 4}\n"
                               "model: {channels: [{cv: y1, mv: u1, gain: 2}, {cv: y2, mv: u2, "
                               "gain: 1}]}\n"
                               "simulation: {aux_movement: {a2: {sigma: 1}}}\n",
                               "u.yaml")
                               .config;
  const auto load_for_plant = [&plant](const std::string& text) {
    return load_scenario_text(text, "s.yaml", plant);
  };
  const ScenarioResult result = load_for_plant(
      "plant:\n"
      "  input: {u2: {deadband: 0.5}, d1: {polynomial: [1, 2]}}\n"
      "  output: {y2: {saturation: [-1, 1]}}\n"
      "  channels:\n"
      "    - {cv: y1, mv: u1, tanks: {time_constants: 5, empty_input: 0, empty_output: 0}}\n"
      "    - {cv: y2, mv: a2, gain: 3, input: {deadband: 0.1}}\n"
      "    - {cv: y1, dv: d1, gain: 1}\n"
      "  state:\n"
      "    - {cv: y2, mv: u2, restoring_force: {cubic: 1}}\n"
      "    - {cv: y2, mv: a2, restoring_force: {cubic: 2}}\n");
  for (const Finding& finding : result.findings) FAIL_CHECK(format(finding));
  const HiddenPlant& hidden = result.scenario.plant;
  CHECK_FALSE(hidden.empty());
  REQUIRE(hidden.input_blocks.size() == 3);
  CHECK(std::get<mpm::Deadband>(hidden.input_blocks[1].value()).width == 0.5);
  CHECK(std::get<mpm::Polynomial>(hidden.input_blocks[2].value()).coefficients.size() == 2);
  CHECK(std::get<mpm::Saturation>(hidden.output_blocks.at(1).value()).high == 1);
  REQUIRE(hidden.channels.size() == 3);
  CHECK(std::holds_alternative<mpm::TankChain>(hidden.channels[0].dynamics));
  CHECK(hidden.channels[1].input == 4);  // a2, behind two MVs, a DV and a1
  CHECK(hidden.channels[1].input_block.has_value());
  CHECK(hidden.channels[2].input == 2);
  REQUIRE(hidden.state_terms.size() == 2);
  CHECK(hidden.state_terms[1].input == 4);
  CHECK(hidden.over(plant.model.channels).size() == 4);  // the tanks replace u1 -> y1
  CHECK(load_for_plant("scenario: a\n").scenario.plant.empty());
  CHECK(load_for_plant("plant: {}\n").scenario.plant.empty());

  const auto only_finding = [&](const std::string& text) {
    const ScenarioResult bad = load_for_plant(text);
    REQUIRE(bad.findings.size() == 1);
    return format(bad.findings[0]);
  };
  CHECK(only_finding("plant:\n  channels: [{cv: y1, mv: a1, gain: 1}]\n") ==
        "s.yaml:2:13: error: plant.channels: 'a1' stands still: give it a sigma in the unit file's "
        "simulation.aux_movement");
  CHECK(only_finding("plant:\n  channels: [{cv: y1, mv: a3, gain: 1}]\n") ==
        "s.yaml:2:27: error: plant.channels[0].mv: 'a3' is no mv, dv or aux of this unit (did you "
        "mean 'a1'?)");
  CHECK(only_finding("plant:\n  input: {a2: {deadband: 1}}\n") ==
        "s.yaml:2:11: error: plant.input.a2: unknown tag (did you mean 'u2'?)");
  CHECK(only_finding("plant:\n  state: [{cv: y1, mv: u2, restoring_force: {cubic: 1}}]\n") ==
        "s.yaml:2:11: error: plant.state[0]: there is no channel from 'u2' to 'y1' for it to act "
        "in");
  const auto product = load_for_plant("plant: {input: {u1: {product: {of: d1, per_unit: 2}}}}\n")
                           .scenario.plant.input_blocks[0];
  REQUIRE(product.has_value());
  CHECK(std::get<mpm::Product>(*product).per_unit == 2.0);
  CHECK(
      only_finding("plant:\n  input: {u1: {product: {of: u1, per_unit: 2}}}\n") ==
      "s.yaml:2:30: error: plant.input.u1.product.of: is the input itself: what goes with its own "
      "place is a `polynomial`");
  CHECK(only_finding("plant:\n  input: {u1: {product: {of: u2}}}\n") ==
        "s.yaml:2:25: error: plant.input.u1.product: `per_unit` is missing");
  CHECK(only_finding("plant:\n  input: {u1: {product: {of: u9, per_unit: 2}}}\n") ==
        "s.yaml:2:30: error: plant.input.u1.product.of: 'u9' is no mv or dv of this unit (did you "
        "mean 'u1'?)");
  CHECK(only_finding("plant: {inputs: {}}\n") ==
        "s.yaml:1:9: error: plant.inputs: unknown key (did you mean 'input'?)");
}
