#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/finding.hpp"
#include "config/unit_config.hpp"

/// What a simulated plant hides from its controller, as plain structs. "Plant against model".
namespace mpm::config {

/// One deliberate difference between plant and model.
struct Change {
  std::optional<std::string> cv;  ///< tag; missing = every CV
  std::optional<std::string> mv;  ///< tag of an MV or DV; missing = every MV
  double gain_ratio = 1.0;
  double time_constant_ratio = 1.0;  ///< > 0
  double dead_time_error_s = 0.0;    ///< plant minus model
  double from_s = 0.0;               ///< time in the run at which it begins
};

/// Draws `count` different channels, and for each one of the values below, from the seed.
struct RandomDraw {
  std::vector<double> gain_ratios;
  std::vector<double> time_constant_ratios;
  std::vector<double> dead_time_errors_s;
  double from_s = 0.0;
  int count = 1;
};

struct NoiseChange {
  std::optional<std::string> cv;  ///< tag; missing = every CV
  double sigma_ratio = 1.0;       ///< >= 0
  double from_s = 0.0;
};

struct ScenarioConfig {
  std::string name;
  std::string description;
  std::vector<Change> changes;
  std::optional<RandomDraw> draw;
  std::vector<NoiseChange> noise;
  std::optional<double> setpoint_amplitude_ratio;  ///< against the unit file's amplitude
  bool constant_setpoints = false;
  bool integral_action = true;        ///< of the controller: offset-free control
  double disturbance_feedback = 1.0;  ///< 0..1, part of the output disturbance that is fed back
  bool allow_unstable = false;        ///< run although integral action cannot hold the plant
  std::vector<MvLimits> mv_limits;    ///< the unit's with the scenario's over them; empty: unit's
  std::vector<CvLimits> cv_limits;
  MonitorSettings monitor;  ///< the unit's with the scenario's over them; for `mpm detect`
};

struct ScenarioResult {
  ScenarioConfig scenario;
  std::vector<Finding> findings;

  [[nodiscard]] bool ok() const { return !has_errors(findings); }
};

/// Reads and checks a scenario against the unit whose tags it names.
[[nodiscard]] ScenarioResult load_scenario(const std::string& path, const UnitConfig& unit);

/// The same from text; `name` stands for the file in the findings.
[[nodiscard]] ScenarioResult load_scenario_text(const std::string& text, const std::string& name,
                                                const UnitConfig& unit);

/// `name` itself if it ends in .yaml or .yml, else NAME.yaml in `scenarios/` beside the unit file,
/// in `../scenarios/`, or among the shipped ones. Throws InputError that lists the known names.
[[nodiscard]] std::string find_scenario(const std::string& name, const std::string& unit_file);

}  // namespace mpm::config
