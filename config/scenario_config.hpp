#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "config/finding.hpp"
#include "config/place.hpp"
#include "config/unit_config.hpp"

/// What a simulated plant hides from its controller, as plain structs. "Plant against model".
/// Times are seconds of the run, sizes CV units: the loader has turned samples, shares of the run
/// and standard deviations into these, and numbers of signals into tags.
namespace mpm::config {

inline constexpr double kForEver = std::numeric_limits<double>::infinity();

/// One deliberate difference between plant and model.
struct Change {
  std::optional<std::string> cv;  ///< tag; missing = every CV
  std::optional<std::string> mv;  ///< tag of an MV or DV; missing = every MV
  double gain_ratio = 1.0;
  double time_constant_ratio = 1.0;  ///< > 0
  double dead_time_error_s = 0.0;    ///< plant minus model
  double from_s = 0.0;               ///< time in the run at which it begins
  double until_s = kForEver;         ///< and at which the plant is the model again
  Place place = {};
};

/// What the plant has from the start on although the model does not. By index: the model's inputs,
/// behind them the aux signals.
struct HiddenPlant {
  std::vector<std::optional<InputBlock>> input_blocks;    ///< none, or one per input of the model
  std::vector<std::optional<OutputBlock>> output_blocks;  ///< none, or one per CV
  std::vector<ChannelSpec> channels;                      ///< in place of the model's, or besides
  std::vector<StateTerm> state_terms;
  Place place = {};

  [[nodiscard]] bool empty() const;
  /// The plant's channels where the model has `known`.
  [[nodiscard]] std::vector<ChannelSpec> over(const std::vector<ChannelSpec>& known) const;
};

/// Draws `count` different channels, and for each one of the values below, from the seed.
struct RandomDraw {
  std::vector<double> gain_ratios;
  std::vector<double> time_constant_ratios;
  std::vector<double> dead_time_errors_s;
  double from_s = 0.0;
  int count = 1;
  double until_s = kForEver;
  Place place = {};
};

/// A change of the unit's own noise on a CV.
struct NoiseChange {
  std::optional<std::string> cv;  ///< tag; missing = every CV
  double sigma_ratio = 1.0;       ///< >= 0
  double from_s = 0.0;
  double until_s = kForEver;
  /// Innovations follow Student's t with so many degrees of freedom (> 2), scaled to the same s.d.
  std::optional<double> student_t = {};
  /// Adds `gain` times the noise that this other CV had `lag_samples` ago.
  std::optional<std::string> follows = {};
  int lag_samples = 0;
  double gain = 1.0;
};

enum class DisturbanceKind {
  kStep,         ///< at once or, with a time constant, through a first-order lag
  kRamp,         ///< grows to its size over the duration, then stays
  kDrift,        ///< noise with a pole near 1, from white innovations with s.d. `size`
  kPeriodic,     ///< a sine of amplitude `size`
  kSensorNoise,  ///< white, s.d. `size`
};

/// What adds itself to one measured CV, beside the unit's own noise.
struct Disturbance {
  DisturbanceKind kind = DisturbanceKind::kStep;
  std::string cv;     ///< tag
  double size = 0.0;  ///< CV units
  double from_s = 0.0;
  double until_s = kForEver;     ///< a step goes back by its lag, all others end at once
  double time_constant_s = 0.0;  ///< of a step
  double duration_s = 0.0;       ///< of a ramp, > 0
  double pole = 0.999;           ///< of a drift
  double period_s = 0.0;         ///< of a sine, > 0
  double phase_degrees = 0.0;    ///< of a sine at the start of the run
};

/// Other limits of one MV than the unit file's.
struct MvLimitChange {
  std::string mv;      ///< tag
  double ratio = 1.0;  ///< scales the distance of low and high from the operating point
  std::optional<double> low = {}, high = {}, max_move = {};  ///< instead, MV units
};

enum class BadDataKind {
  kMissing,     ///< no value, quality bad
  kUncertain,   ///< the true value, quality uncertain
  kGaps,        ///< whole rows are not reported
  kFrozen,      ///< the value repeats, quality good
  kSpikes,      ///< the value plus or minus a size, quality good
  kClipping,    ///< values beyond a range read as its end
  kTimeJitter,  ///< time stamps are off by up to `share` of the sample time to either side
  kClockSteps,  ///< the clock jumps
};

/// A number of a plant of its own equations that is other than it was (`simulation: process:`).
struct ProcessChange {
  std::string quantity;  ///< such as `co_oxidation`; the process knows its own
  double value = 0.0;
  double from_s = 0.0;
  double until_s = kForEver;
  Place place = {};
};

/// A test of one MV while the controller is off: two levels around the operating point.
struct TestSignal {
  std::string mv;       ///< tag
  double size = 0.0;    ///< to either side, MV units
  double hold_s = 0.0;  ///< > 0; `random`: after each, either level by the toss of a coin
  bool random = true;   ///< else one after the other, the upper one first
  double from_s = 0.0;
  double until_s = kForEver;
};

/// What goes wrong between the loop and whoever reads its data. The loop itself sees nothing of it.
struct BadData {
  BadDataKind kind = BadDataKind::kMissing;
  std::vector<std::string> tags;  ///< of MVs, DVs, CVs, predictions or set-points
  double share = 0.0;             ///< of the samples of each tag, or of the rows
  int run_samples = 0;            ///< length of a run; 0 = every sample for itself
  std::vector<double> sizes;      ///< of spikes, one per tag
  /// Of clipping; missing = the range that `share` of the run's values lie beyond.
  std::optional<double> low = {}, high = {};
  std::vector<double> steps_s;  ///< of the clock, one after the other, at random times
  double from_s = 0.0;
  double until_s = kForEver;
};

[[nodiscard]] std::string name_of(BadDataKind kind);

struct TimeSpan {
  double from_s = 0.0;
  double until_s = kForEver;
};

struct ScenarioConfig {
  std::string name;
  std::string description;
  std::vector<Change> changes;
  std::optional<RandomDraw> draw;
  HiddenPlant plant;
  std::vector<NoiseChange> noise;
  std::vector<Disturbance> disturbances;
  std::optional<double> setpoint_amplitude_ratio;  ///< against the unit file's amplitude
  bool constant_setpoints = false;
  /// CVs by tag whose set-points move together, in shares of their amplitudes, as the first does.
  std::vector<std::string> equal_setpoints;
  /// CVs by tag whose set-points move at all; missing = every one.
  std::optional<std::vector<std::string>> moving_setpoints;
  bool integral_action = true;           ///< of the controller: offset-free control
  double disturbance_feedback = 1.0;     ///< 0..1, part of the output disturbance that is fed back
  std::vector<TimeSpan> controller_off;  ///< MVs stay where they are
  std::vector<TestSignal> tests;         ///< off as well, while any of them lasts
  std::vector<ProcessChange> process;
  std::vector<MvLimitChange> mv_limits;
  bool allow_unstable = false;  ///< run although integral action cannot hold the plant
  std::vector<BadData> bad_data;
  MonitorSettings monitor;  ///< the unit's with the scenario's over them; for `mpm detect`
};

struct ScenarioResult {
  ScenarioConfig scenario;
  std::vector<Finding> findings;

  [[nodiscard]] bool ok() const { return !has_errors(findings); }
};

/// Reads and checks a scenario against the unit whose tags it names. `run_s`, the length of the
/// run, is what times in per cent refer to; without it they are an error.
[[nodiscard]] ScenarioResult load_scenario(const std::string& path, const UnitConfig& unit,
                                           std::optional<double> run_s = std::nullopt);

/// The same from text; `name` stands for the file in the findings.
[[nodiscard]] ScenarioResult load_scenario_text(const std::string& text, const std::string& name,
                                                const UnitConfig& unit,
                                                std::optional<double> run_s = std::nullopt);

/// Adds one entry of `bad_data` as the command line gives it: `KIND=SHARE`, then more of the
/// entry's keys, such as `frozen=5%,run=60`.
[[nodiscard]] std::vector<Finding> add_bad_data(const std::string& text, const UnitConfig& unit,
                                                std::optional<double> run_s,
                                                ScenarioConfig& scenario);

/// `name` itself if it ends in .yaml or .yml, else NAME.yaml in `scenarios/` beside the unit file,
/// in `../scenarios/`, or among the shipped ones. Throws InputError that lists the known names.
[[nodiscard]] std::string find_scenario(const std::string& name, const std::string& unit_file);

}  // namespace mpm::config
