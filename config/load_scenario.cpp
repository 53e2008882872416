#include <algorithm>
#include <filesystem>

#include "config/load_scenario_parts.hpp"
#include "config/scenario_config.hpp"
#include "config/yaml_text.hpp"

namespace mpm::config {
namespace {

using OptionalTag = std::optional<std::string>;

/// The tags that `key` names: one, a list, or none = every one.
std::vector<OptionalTag> read_tags(const Map& map, std::string_view key,
                                   const std::vector<std::string>& known, std::string_view noun) {
  if (map.find(key) == nullptr) return {std::nullopt};
  std::vector<OptionalTag> tags;
  for (const int index : read_signals(map, key, known, noun))
    tags.emplace_back(known[static_cast<std::size_t>(index)]);
  return tags;
}

/// `4`, `4 s` or `2 samples`, of either sign.
double read_dead_time_error(const Value& value, const UnitConfig& unit) {
  const Quantity error = value.quantity({"samples", "s"}).value_or(Quantity{});
  return error.unit == "samples" ? error.number * unit.sample_time_s : error.number;
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
    const auto* tanks = std::get_if<TankChain>(&channel.dynamics);
    const double dead_time_s = tf != nullptr      ? tf->dead_time_s
                               : tanks != nullptr ? tanks->dead_time_s
                                                  : kForEver;
    if (dead_time_s + change.dead_time_error_s < 0.0)
      item.error("dead_time_error " + yaml_text(change.dead_time_error_s) +
                 " makes the dead time of " + input + " -> " + cv +
                 " negative (model: " + yaml_text(dead_time_s) + " s)");
  }
  if (!matched)
    item.error("the model has no channel " + change.mv.value_or("(any)") + " -> " +
               change.cv.value_or("(any)"));
}

void load_change(const Value& item, const ScenarioContext& context, ScenarioConfig& scenario) {
  const UnitConfig& unit = context.unit;
  const Map map = item.map(
      {"cv", "mv", "gain_ratio", "time_constant_ratio", "dead_time_error", "from", "until"});
  Change change;
  change.place = item.where();
  if (const Value* ratio = map.find("gain_ratio"))
    change.gain_ratio = ratio->number().value_or(1.0);
  if (const Value* ratio = map.find("time_constant_ratio"))
    change.time_constant_ratio = ratio->number(kPositive).value_or(1.0);
  if (const Value* error = map.find("dead_time_error"))
    change.dead_time_error_s = read_dead_time_error(*error, unit);
  read_span(map, context, change.from_s, change.until_s);
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

void load_draw(const Value& value, const ScenarioContext& context, ScenarioConfig& scenario) {
  const UnitConfig& unit = context.unit;
  const Map map =
      value.map({"gain_ratio", "time_constant_ratio", "dead_time_error", "from", "until", "count"});
  RandomDraw draw;
  draw.place = value.where();
  if (const Value* list = map.find("gain_ratio")) draw.gain_ratios = list->numbers();
  if (const Value* list = map.find("time_constant_ratio"))
    draw.time_constant_ratios = list->numbers(kPositive);
  if (const Value* list = map.find("dead_time_error"))
    for (const Value& item : list->items())
      draw.dead_time_errors_s.push_back(read_dead_time_error(item, unit));
  if (draw.gain_ratios.empty() && draw.time_constant_ratios.empty() &&
      draw.dead_time_errors_s.empty())
    value.error("draws nothing: give gain_ratio, time_constant_ratio or dead_time_error");
  read_span(map, context, draw.from_s, draw.until_s);
  const double channels = unit.model.channels.empty()
                              ? static_cast<double>(unit.model.input_count) * unit.model.cv_count
                              : static_cast<double>(unit.model.channels.size());
  if (const Value* count = map.find("count"))
    draw.count = count->integer({.low = 1, .high = std::max(1.0, channels)}).value_or(1);
  scenario.draw = std::move(draw);
}

void load_root(const Value& document, const ScenarioContext& context, ScenarioConfig& scenario) {
  if (!document.is_map()) {
    document.error("a scenario is a map of keys such as `scenario:` and `changes:`");
    return;
  }
  const Map root =
      document.map({"scenario", "description", "changes", "draw", "plant", "noise", "disturbances",
                    "setpoints", "controller", "tests", "process", "bad_data", "monitor"});
  if (const Value* name = root.find("scenario"))
    scenario.name = name->text().value_or(scenario.name);
  if (const Value* text = root.find("description"))
    scenario.description = text->free_text().value_or("");
  load_list(root, "changes", [&](const Value& item) { load_change(item, context, scenario); });
  if (const Value* draw = root.find("draw")) load_draw(*draw, context, scenario);
  if (const Value* plant = root.find("plant")) load_hidden_plant(*plant, context, scenario);
  load_list(root, "noise", [&](const Value& item) { load_noise(item, context, scenario); });
  load_list(root, "disturbances",
            [&](const Value& item) { load_disturbance(item, context, scenario); });
  if (const Value* setpoints = root.find("setpoints"))
    load_scenario_setpoints(*setpoints, context, scenario);
  if (const Value* controller = root.find("controller"))
    load_scenario_controller(*controller, context, scenario);
  load_list(root, "tests", [&](const Value& item) { load_test(item, context, scenario); });
  load_list(root, "process",
            [&](const Value& item) { load_process_change(item, context, scenario); });
  load_list(root, "bad_data", [&](const Value& item) { load_bad_data(item, context, scenario); });
  scenario.monitor = context.unit.monitor;
  load_monitor(root.find("monitor"), context.unit, scenario.monitor);
}

ScenarioResult load_text(const std::string& text, const std::string& name,
                         const ScenarioContext& context, Report& report) {
  ScenarioResult result;
  result.scenario.name = std::filesystem::path(name).stem().string();
  if (const std::optional<Value> document = parse_yaml(text, report))
    load_root(*document, context, result.scenario);
  return result;
}

}  // namespace

ScenarioResult load_scenario(const std::string& path, const UnitConfig& unit,
                             std::optional<double> run_s) {
  ScenarioResult result;
  Report report(path);
  if (const std::optional<std::string> text = read_text_file(path, report))
    result = load_text(*text, path, {unit, run_s}, report);
  result.findings = report.take();
  return result;
}

ScenarioResult load_scenario_text(const std::string& text, const std::string& name,
                                  const UnitConfig& unit, std::optional<double> run_s) {
  Report report(name);
  ScenarioResult result = load_text(text, name, {unit, run_s}, report);
  result.findings = report.take();
  return result;
}

}  // namespace mpm::config
