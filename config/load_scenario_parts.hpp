#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "config/load_sections.hpp"
#include "config/scenario_config.hpp"

/// Readers of a scenario's sections. Private to this room.
namespace mpm::config {

/// What the sections are read against.
struct ScenarioContext {
  const UnitConfig& unit;
  std::optional<double> run_s;  ///< length of the run, if known
};

/// `100` or `100 s`, `20 samples`, or `50 %` of the run; in seconds.
[[nodiscard]] std::optional<double> read_time(const Value& value, const ScenarioContext& context,
                                              const Range& range = kNotNegative);
/// `from` and `until`.
void read_span(const Map& map, const ScenarioContext& context, double& from_s, double& until_s);
/// s.d. of the unit's noise on a CV; reported at `value` where it is 0.
[[nodiscard]] double noise_deviation(const ScenarioContext& context, int cv, const Value& value);
/// `0.5` in CV units or `3 sd` of the unit's noise on that CV; in CV units.
[[nodiscard]] double read_size(const Value& value, const ScenarioContext& context, int cv,
                               const Range& range = kAny);

/// Index of the signal that `value` names by its tag or by its place in the unit file from 1, or -1
/// (reported).
[[nodiscard]] int find_signal(const Value& value, const std::vector<std::string>& known,
                              std::string_view noun);
/// Indices of the signals that `key` names: one, a list, or none = every one.
[[nodiscard]] std::vector<int> read_signals(const Map& map, std::string_view key,
                                            const std::vector<std::string>& known,
                                            std::string_view noun);

void load_hidden_plant(const Value& section, const ScenarioContext& context,
                       ScenarioConfig& scenario);
void load_noise(const Value& item, const ScenarioContext& context, ScenarioConfig& scenario);
void load_disturbance(const Value& item, const ScenarioContext& context, ScenarioConfig& scenario);
void load_bad_data(const Value& item, const ScenarioContext& context, ScenarioConfig& scenario);
void load_scenario_setpoints(const Value& section, const ScenarioContext& context,
                             ScenarioConfig& scenario);
void load_test(const Value& item, const ScenarioContext& context, ScenarioConfig& scenario);
void load_process_change(const Value& item, const ScenarioContext& context,
                         ScenarioConfig& scenario);
void load_scenario_controller(const Value& section, const ScenarioContext& context,
                              ScenarioConfig& scenario);

template <class Load>
void load_list(const Map& root, std::string_view key, Load load) {
  const Value* list = root.find(key);
  if (list == nullptr || list->is_null()) return;
  for (const Value& item : list->items()) load(item);
}

}  // namespace mpm::config
