#include <algorithm>
#include <filesystem>

#include "config/load_sections.hpp"
#include "config/scenario_config.hpp"
#include "config/yaml_text.hpp"

namespace mpm::config {
namespace {

void read_from(const Map& map, double& from_s) {
  if (const Value* from = map.find("from")) from_s = from->number(kNotNegative).value_or(0.0);
}

/// The tags that `key` names: one, a list, or none = every one.
std::vector<std::optional<std::string>> read_tags(const Map& map, std::string_view key,
                                                  const std::vector<std::string>& known,
                                                  std::string_view noun) {
  const Value* value = map.find(key);
  if (value == nullptr) return {std::nullopt};
  std::vector<std::optional<std::string>> tags;
  for (const Value& item : value->items())
    if (const int index = find_tag(item, known, noun); index >= 0)
      tags.emplace_back(known[static_cast<std::size_t>(index)]);
  return tags;
}

/// Complains about a change that no channel of the model could show.
void check_change(const Value& item, const Change& change, const UnitConfig& unit) {
  if (unit.model.channels.empty()) return;
  bool matched = false;
  for (const ChannelSpec& channel : unit.model.channels) {
    const std::string& cv = unit.cv[static_cast<std::size_t>(channel.cv)].tag;
    const std::string& input = unit.input_tag(channel.input);
    if ((change.cv && *change.cv != cv) || (change.mv && *change.mv != input)) continue;
    matched = true;
    const auto* tf = std::get_if<TransferFunction>(&channel.dynamics);
    if (tf != nullptr && tf->dead_time_s + change.dead_time_error_s < 0.0)
      item.error("dead_time_error " + yaml_text(change.dead_time_error_s) +
                 " makes the dead time of " + input + " -> " + cv +
                 " negative (model: " + yaml_text(tf->dead_time_s) + " s)");
  }
  if (!matched)
    item.error("the model has no channel " + change.mv.value_or("(any)") + " -> " +
               change.cv.value_or("(any)"));
}

void load_change(const Value& item, const UnitConfig& unit, ScenarioConfig& scenario) {
  const Map map =
      item.map({"cv", "mv", "gain_ratio", "time_constant_ratio", "dead_time_error", "from"});
  Change change;
  if (const Value* ratio = map.find("gain_ratio"))
    change.gain_ratio = ratio->number().value_or(1.0);
  if (const Value* ratio = map.find("time_constant_ratio"))
    change.time_constant_ratio = ratio->number(kPositive).value_or(1.0);
  if (const Value* error = map.find("dead_time_error"))
    change.dead_time_error_s = error->number().value_or(0.0);
  read_from(map, change.from_s);
  if (map.find("gain_ratio") == nullptr && map.find("time_constant_ratio") == nullptr &&
      map.find("dead_time_error") == nullptr)
    item.error("changes nothing: give gain_ratio, time_constant_ratio or dead_time_error");
  for (const auto& cv : read_tags(map, "cv", unit.cv_tags(), "cv")) {
    for (const auto& mv : read_tags(map, "mv", unit.input_tags(), "mv or dv")) {
      change.cv = cv;
      change.mv = mv;
      check_change(item, change, unit);
      scenario.changes.push_back(change);
    }
  }
}

void load_draw(const Value& value, const UnitConfig& unit, ScenarioConfig& scenario) {
  const Map map =
      value.map({"gain_ratio", "time_constant_ratio", "dead_time_error", "from", "count"});
  RandomDraw draw;
  if (const Value* list = map.find("gain_ratio")) draw.gain_ratios = list->numbers();
  if (const Value* list = map.find("time_constant_ratio"))
    draw.time_constant_ratios = list->numbers(kPositive);
  if (const Value* list = map.find("dead_time_error")) draw.dead_time_errors_s = list->numbers();
  if (draw.gain_ratios.empty() && draw.time_constant_ratios.empty() &&
      draw.dead_time_errors_s.empty())
    value.error("draws nothing: give gain_ratio, time_constant_ratio or dead_time_error");
  read_from(map, draw.from_s);
  const double channels = unit.model.channels.empty()
                              ? static_cast<double>(unit.model.input_count) * unit.model.cv_count
                              : static_cast<double>(unit.model.channels.size());
  if (const Value* count = map.find("count"))
    draw.count = count->integer({.low = 1, .high = std::max(1.0, channels)}).value_or(1);
  scenario.draw = std::move(draw);
}

void load_noise(const Value& item, const UnitConfig& unit, ScenarioConfig& scenario) {
  const Map map = item.map({"cv", "sigma_ratio", "from"});
  NoiseChange change;
  if (const Value* ratio = map.require("sigma_ratio"))
    change.sigma_ratio = ratio->number(kNotNegative).value_or(1.0);
  read_from(map, change.from_s);
  for (const auto& cv : read_tags(map, "cv", unit.cv_tags(), "cv")) {
    change.cv = cv;
    scenario.noise.push_back(change);
  }
}

void load_loop(const Map& root, ScenarioConfig& scenario) {
  if (const Value* setpoints = root.find("setpoints")) {
    const Map map = setpoints->map({"amplitude_ratio", "constant"});
    if (const Value* ratio = map.find("amplitude_ratio"))
      scenario.setpoint_amplitude_ratio = ratio->number(kNotNegative);
    if (const Value* constant = map.find("constant"))
      scenario.constant_setpoints = constant->boolean().value_or(false);
  }
  if (const Value* controller = root.find("controller")) {
    const Map map = controller->map({"integral_action", "disturbance_feedback", "allow_unstable"});
    if (const Value* flag = map.find("integral_action"))
      scenario.integral_action = flag->boolean().value_or(true);
    if (const Value* part = map.find("disturbance_feedback"))
      scenario.disturbance_feedback = part->number({.low = 0.0, .high = 1.0}).value_or(1.0);
    if (const Value* flag = map.find("allow_unstable"))
      scenario.allow_unstable = flag->boolean().value_or(false);
  }
}

void load_limits(const Value* section, const UnitConfig& unit, ScenarioConfig& scenario) {
  if (section == nullptr) return;
  SimulationSettings simulation = unit.simulation;
  load_limits(*section, unit, simulation);
  scenario.mv_limits = std::move(simulation.mv_limits);
  scenario.cv_limits = std::move(simulation.cv_limits);
}

template <class Load>
void load_list(const Map& root, std::string_view key, Load load) {
  const Value* list = root.find(key);
  if (list == nullptr || list->is_null()) return;
  for (const Value& item : list->items()) load(item);
}

void load_root(const Value& document, const UnitConfig& unit, ScenarioConfig& scenario) {
  if (!document.is_map()) {
    document.error("a scenario is a map of keys such as `scenario:` and `changes:`");
    return;
  }
  const Map root = document.map({"scenario", "description", "changes", "draw", "noise", "setpoints",
                                 "controller", "limits", "monitor"});
  if (const Value* name = root.find("scenario"))
    scenario.name = name->text().value_or(scenario.name);
  if (const Value* text = root.find("description"))
    scenario.description = text->free_text().value_or("");
  load_list(root, "changes", [&](const Value& item) { load_change(item, unit, scenario); });
  if (const Value* draw = root.find("draw")) load_draw(*draw, unit, scenario);
  load_list(root, "noise", [&](const Value& item) { load_noise(item, unit, scenario); });
  load_loop(root, scenario);
  load_limits(root.find("limits"), unit, scenario);
  scenario.monitor = unit.monitor;
  load_monitor(root.find("monitor"), unit.sample_time_s, scenario.monitor);
}

ScenarioResult load_text(const std::string& text, const std::string& name, const UnitConfig& unit,
                         Report& report) {
  ScenarioResult result;
  result.scenario.name = std::filesystem::path(name).stem().string();
  if (const std::optional<Value> document = parse_yaml(text, report))
    load_root(*document, unit, result.scenario);
  return result;
}

}  // namespace

ScenarioResult load_scenario(const std::string& path, const UnitConfig& unit) {
  ScenarioResult result;
  Report report(path);
  if (const std::optional<std::string> text = read_text_file(path, report))
    result = load_text(*text, path, unit, report);
  result.findings = report.take();
  return result;
}

ScenarioResult load_scenario_text(const std::string& text, const std::string& name,
                                  const UnitConfig& unit) {
  Report report(name);
  ScenarioResult result = load_text(text, name, unit, report);
  result.findings = report.take();
  return result;
}

}  // namespace mpm::config
