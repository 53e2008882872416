#include <array>
#include <cstdio>
#include <utility>

#include "tests/study/experiment.hpp"

namespace mpm::study {
namespace {

constexpr int kShort = 1000;
constexpr int kUsual = 3000;

// Scenarios in which no channel is wrong: the noise changes or something else disturbs the CVs; and
// there is little to learn from.
constexpr std::array kEvents = {"noise_x3",    "sensor_noise", "periodic",   "coupled_noise",
                                "heavy_tails", "all_events",   "step_small", "step_large",
                                "lagged_step", "ramp",         "drift"};
constexpr std::array kQuiet = {"constant_setpoints", "equal_setpoints", "one_setpoint",
                               "controller_off", "constrained"};

Experiment usual(const std::string& scenario, int runs = 100) {
  Experiment experiment;
  experiment.name = scenario;
  experiment.scenario = scenario;
  experiment.samples = kUsual;
  experiment.also_at = {kShort};
  experiment.seeds = {1, static_cast<std::uint64_t>(runs)};
  return experiment;
}

std::string number_name(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

/// Single errors of one channel of Shell 3x3, growing.
void add_grid(std::vector<Experiment>& experiments) {
  const std::vector<std::pair<int, int>> channels = {{0, 0}, {1, 1}, {1, 2}, {2, 2}};  // CV, MV
  const auto add = [&](const std::string& what, const std::string& row, double gain,
                       double time_constant, double dead_time_s) {
    for (const auto& [cv, mv] : channels) {
      Experiment experiment = usual("none", 30);
      experiment.column = "u" + std::to_string(mv + 1) + " -> y" + std::to_string(cv + 1);
      experiment.row = row;
      experiment.name =
          "grid_" + what + "_y" + std::to_string(cv + 1) + "u" + std::to_string(mv + 1);
      experiment.changes = {{.cv = cv,
                             .input = mv,
                             .gain_ratio = gain,
                             .time_constant_ratio = time_constant,
                             .dead_time_error_s = dead_time_s}};
      experiments.push_back(experiment);
    }
  };
  for (const double percent : {3.0, 5.0, 8.0, 10.0, 15.0, 20.0})
    add("gain" + number_name(percent), "gain +" + number_name(percent) + " %",
        1.0 + percent / 100.0, 1.0, 0.0);
  for (const double percent : {5.0, 10.0, 15.0, 20.0, 30.0})
    add("lag" + number_name(percent), "time constant +" + number_name(percent) + " %", 1.0,
        1.0 + percent / 100.0, 0.0);
  for (const double samples : {0.25, 0.5, 1.0})
    add("delay" + number_name(samples), "dead time +" + number_name(samples) + " samples", 1.0, 1.0,
        samples);
}

/// Errors that begin, or come and go, inside a run.
void add_changes(std::vector<Experiment>& experiments) {
  for (const char* scenario : {"change_gain_mv1_cv1", "change_gain_mv3_cv2", "change_gain_mv3_cv3",
                               "change_time_constant", "change_delay", "change_and_back"}) {
    Experiment experiment = usual(scenario, 50);
    experiment.samples = 6000;
    experiment.also_at = {};
    experiments.push_back(experiment);
  }
  experiments.back().samples = 12000;
}

/// The long memory as a window with sharp edges instead of an exponential one.
void add_windows(std::vector<Experiment>& experiments) {
  for (const char* scenario : {"none", "hidden_gain", "change_gain_mv3_cv2", "change_delay"}) {
    Experiment experiment = usual(scenario, 50);
    experiment.name = std::string("window_") + scenario;
    experiment.samples = 6000;
    experiment.also_at = {};
    experiment.settings = [](MonitorSettings& settings) { settings.sliding_window = true; };
    experiments.push_back(experiment);
  }
}

Experiment long_run(const std::string& unit, int runs) {
  Experiment experiment;
  experiment.name = "long_" + unit;
  experiment.unit = unit;
  experiment.samples = 100000;
  experiment.seeds = {1001, 1000 + static_cast<std::uint64_t>(runs)};
  return experiment;
}

}  // namespace

Study full_study() {
  Study study;
  std::vector<Experiment>& experiments = study.experiments;
  experiments.push_back(usual("none", 200));
  for (const char* scenario : kEvents) experiments.push_back(usual(scenario));
  for (const char* scenario : kQuiet) experiments.push_back(usual(scenario));
  for (const char* scenario : {"s2_gain15", "s3_delay", "s4_gain40", "hidden_gain"})
    experiments.push_back(usual(scenario));
  for (Experiment& experiment : experiments)
    if (experiment.name == "s4_gain40") experiment.material = 0.1;
  add_changes(experiments);
  add_windows(experiments);
  add_grid(experiments);
  for (const std::string unit : {"wood_berry", "shell7x5", "ogunnaike_ray"}) {
    for (const std::string scenario : {"none", "hidden_gain"}) {
      Experiment experiment = usual(scenario);
      experiment.unit = unit;
      experiment.name = unit + "_" + scenario;
      experiments.push_back(experiment);
    }
  }
  experiments.push_back(long_run("shell3x3", 50));
  experiments.push_back(long_run("wood_berry", 20));

  std::vector<std::string> healthy = {"none", "*_none"};
  healthy.insert(healthy.end(), kEvents.begin(), kEvents.end());
  healthy.insert(healthy.end(), kQuiet.begin(), kQuiet.end());
  std::vector<std::string> quiet = {"none"};
  quiet.insert(quiet.end(), kQuiet.begin(), kQuiet.end());
  study.tables = {
      {"healthy", TableKind::kHealthy, healthy},
      {"excitation", TableKind::kVerdicts, quiet},
      {"detection",
       TableKind::kPower,
       {"s2_gain15", "s3_delay", "s4_gain40", "hidden_gain", "*_hidden_gain"}},
      {"grid", TableKind::kGrid, {"grid_*"}},
      {"changes", TableKind::kChange, {"change_*", "window_*"}},
      {"run_length", TableKind::kRunLength, {"long_*"}},
      {"tail", TableKind::kTail, {"none", "wood_berry_none", "long_*"}},
  };
  return study;
}

// The bounds allow for what finite samples do to nominal rates (1 % of channels with p < 0.01, 1 %
// of runs with a false mismatch); one is broken only by counts that a rate at the bound would give
// in fewer than one of 10 000 studies.
Study short_study() {
  using Side = Bound::Side;
  Study study;
  const auto add = [&](const std::string& unit, const std::string& scenario, int runs, int samples,
                       std::vector<Bound> bounds) {
    Experiment experiment;
    experiment.name = unit == "shell3x3" ? scenario : unit + "_" + scenario;
    experiment.unit = unit;
    experiment.scenario = scenario;
    experiment.samples = samples;
    experiment.seeds = {90001, 90000 + static_cast<std::uint64_t>(runs)};
    if (scenario == "s4_gain40") experiment.material = 0.1;
    experiment.bounds = std::move(bounds);
    study.experiments.push_back(experiment);
  };
  const auto healthy = [](int at) -> std::vector<Bound> {
    return {{"healthy_p_0.05", at, Side::kAtMost, 0.07},
            {"healthy_p_0.01", at, Side::kAtMost, 0.02},
            {"false_mismatch_runs", at, Side::kAtMost, 0.02},
            {"false_alarm_runs", 0, Side::kAtMost, 1e-4}};
  };
  const auto wrong = [](int at, double found) -> std::vector<Bound> {
    return {{"wrong_mismatch", at, Side::kAtLeast, found},
            {"ranked", at, Side::kAtLeast, 0.98},
            {"first_alarm_right", 0, Side::kAtLeast, 0.99},
            {"false_alarm_runs", 0, Side::kAtMost, 1e-4}};
  };
  constexpr int kSamples = 1500;
  add("shell3x3", "none", 120, kSamples, healthy(kSamples));
  add("wood_berry", "none", 60, kSamples, healthy(kSamples));
  for (const char* scenario : {"noise_x3", "coupled_noise", "heavy_tails", "all_events", "drift"})
    add("shell3x3", scenario, 30, kSamples, healthy(kSamples));
  add("shell3x3", "hidden_gain", 40, kSamples, wrong(kSamples, 0.98));
  add("wood_berry", "hidden_gain", 30, kSamples, wrong(kSamples, 0.98));
  add("shell3x3", "s2_gain15", 20, kSamples, wrong(kSamples, 0.95));
  add("shell3x3", "s3_delay", 20, kShort, wrong(kShort, 0.98));
  add("shell3x3", "s4_gain40", 20, kShort, wrong(kShort, 0.98));
  add("shell3x3", "constant_setpoints", 20, kSamples,
      {{"healthy_match", kSamples, Side::kAtMost, 1e-4},
       {"healthy_mismatch", kSamples, Side::kAtMost, 1e-4},
       {"false_alarm_runs", 0, Side::kAtMost, 1e-4}});
  study.tables = {
      {"healthy",
       TableKind::kHealthy,
       {"none", "wood_berry_none", "noise_x3", "coupled_noise", "heavy_tails", "all_events",
        "drift", "constant_setpoints"}},
      {"detection",
       TableKind::kPower,
       {"hidden_gain", "wood_berry_hidden_gain", "s2_gain15", "s3_delay", "s4_gain40"}}};
  return study;
}

}  // namespace mpm::study
