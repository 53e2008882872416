#include <array>
#include <cstdio>
#include <utility>

#include "tests/study/experiment.hpp"

namespace mpm::study {
namespace {

constexpr int kShort = 1000;
constexpr int kUsual = 3000;

Experiment usual(const std::string& scenario, int runs = 100) {
  Experiment experiment;
  experiment.name = scenario;
  experiment.scenario = scenario;
  experiment.samples = kUsual;
  experiment.also_at = {kShort};
  experiment.seeds = {1, static_cast<std::uint64_t>(runs)};
  return experiment;
}

std::string number(double value) {
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
      experiment.name = "grid_" + what + "_y" + std::to_string(cv + 1) + "u" +
                        std::to_string(mv + 1);
      experiment.changes = {{.cv = cv,
                             .input = mv,
                             .gain_ratio = gain,
                             .time_constant_ratio = time_constant,
                             .dead_time_error_s = dead_time_s}};
      experiments.push_back(experiment);
    }
  };
  for (const double percent : {3.0, 5.0, 8.0, 10.0, 15.0, 20.0})
    add("gain" + number(percent), "gain +" + number(percent) + " %", 1.0 + percent / 100.0, 1.0,
        0.0);
  for (const double percent : {5.0, 10.0, 15.0, 20.0, 30.0})
    add("lag" + number(percent), "time constant +" + number(percent) + " %", 1.0,
        1.0 + percent / 100.0, 0.0);
  for (const double samples : {0.25, 0.5, 1.0})
    add("delay" + number(samples), "dead time +" + number(samples) + " samples", 1.0, 1.0,
        samples);
}

/// Errors that begin at sample 3000 of 6000, and go at 3000 of 9000 after having come at 1500.
void add_changes(std::vector<Experiment>& experiments) {
  const auto add = [&](const std::string& name, std::vector<sim::ChannelChange> changes) {
    Experiment experiment = usual("none", 30);
    experiment.name = name;
    experiment.samples = 6000;
    experiment.also_at = {};
    experiment.changes = std::move(changes);
    experiments.push_back(experiment);
  };
  const double from_s = 3000.0;
  add("begins_none", {});
  add("begins_gain_y1u1", {{.cv = 0, .input = 0, .gain_ratio = 0.85, .from_s = from_s}});
  add("begins_gain_y2u3", {{.cv = 1, .input = 2, .gain_ratio = 0.75, .from_s = from_s}});
  add("begins_gain_y3u3", {{.cv = 2, .input = 2, .gain_ratio = 0.90, .from_s = from_s}});
  add("begins_lag_y2u3", {{.cv = 1, .input = 2, .time_constant_ratio = 1.3, .from_s = from_s}});
  add("begins_delay_u1", {{.cv = 0, .input = 0, .dead_time_error_s = 4.0, .from_s = from_s},
                          {.cv = 1, .input = 0, .dead_time_error_s = 4.0, .from_s = from_s},
                          {.cv = 2, .input = 0, .dead_time_error_s = 4.0, .from_s = from_s}});
  add("returns_gain_y2u3",
      {{.cv = 1, .input = 2, .gain_ratio = 0.75, .from_s = 1500.0},
       {.cv = 1, .input = 2, .gain_ratio = 1.0 / 0.75, .from_s = 3000.0}});
  experiments.back().samples = 12000;
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
  for (const char* scenario :
       {"noise_x3", "sensor_noise", "periodic", "coupled_noise", "heavy_tails", "all_events",
        "step_small", "step_large", "lagged_step", "ramp", "drift"})
    experiments.push_back(usual(scenario));
  for (const char* scenario : {"constant_setpoints", "equal_setpoints", "one_setpoint"})
    experiments.push_back(usual(scenario));
  for (const char* scenario : {"s2_gain15", "s3_delay", "s4_gain40", "hidden_gain"})
    experiments.push_back(usual(scenario));
  for (Experiment& experiment : experiments)
    if (experiment.name == "s4_gain40") experiment.material = 0.1;
  add_changes(experiments);
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

  const std::vector<std::string> healthy = {
      "none",        "noise_x3",   "sensor_noise", "periodic",           "coupled_noise",
      "heavy_tails", "all_events", "step_small",   "step_large",         "lagged_step",
      "ramp",        "drift",      "*_none",       "constant_setpoints", "equal_setpoints",
      "one_setpoint"};
  study.tables = {
      {"healthy", TableKind::kHealthy, healthy},
      {"excitation",
       TableKind::kVerdicts,
       {"none", "constant_setpoints", "equal_setpoints", "one_setpoint"}},
      {"detection",
       TableKind::kPower,
       {"s2_gain15", "s3_delay", "s4_gain40", "hidden_gain", "*_hidden_gain"}},
      {"grid", TableKind::kGrid, {"grid_*"}},
      {"changes", TableKind::kChange, {"begins_*", "returns_*", "change_*"}},
      {"run_length", TableKind::kRunLength, {"long_*"}},
      {"tail", TableKind::kTail, {"none", "wood_berry_none", "long_*"}},
  };
  return study;
}

Study short_study() {
  Study study;
  const auto add = [&](const std::string& scenario, int runs, int samples) -> Experiment& {
    Experiment experiment;
    experiment.name = scenario;
    experiment.scenario = scenario;
    experiment.samples = samples;
    experiment.seeds = {90001, 90000 + static_cast<std::uint64_t>(runs)};
    study.experiments.push_back(experiment);
    return study.experiments.back();
  };
  add("none", 100, 1500);
  add("hidden_gain", 40, 1500);
  add("s3_delay", 20, 1000);
  add("constant_setpoints", 20, 1500);
  study.tables = {{"healthy", TableKind::kHealthy, {"none", "constant_setpoints"}},
                  {"detection", TableKind::kPower, {"hidden_gain", "s3_delay"}}};
  return study;
}

}  // namespace mpm::study
