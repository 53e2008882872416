#include <algorithm>
#include <numeric>

#include "config/load_sections.hpp"

namespace mpm::config {
namespace {

/// `{y1: 2, y2: 1}` or one number for all.
void read_weights(const Map& map, std::string_view key, const std::vector<std::string>& tags,
                  std::vector<double>& weights) {
  const Value* value = map.find(key);
  if (value == nullptr) return;
  if (value->is_scalar()) {
    const std::optional<double> weight = value->number(kNotNegative);
    if (weight) weights.assign(tags.size(), *weight);
    return;
  }
  const Map by_tag = value->map(tags, "tag");
  for (const Map::Entry& entry : by_tag.entries()) {
    const auto index = std::find(tags.begin(), tags.end(), entry.key) - tags.begin();
    double& weight = weights[static_cast<std::size_t>(index)];
    weight = entry.value.number(kNotNegative).value_or(weight);
  }
}

/// `{y1: {...}, y2: {...}}`, or `{...}` for all tags.
template <class Settings>
void read_each(const Map& map, std::string_view key, const std::vector<std::string>& tags,
               const std::vector<Field<Settings>>& fields, std::vector<Settings>& settings) {
  const Value* value = map.find(key);
  if (value == nullptr) return;
  const std::vector<std::string> names = keys(fields);
  if (value->has_any_key(names) && !value->has_any_key(tags)) {
    for (Settings& each : settings) read_fields(value->map(names), fields, each);
    return;
  }
  std::vector<std::string> known = tags;
  known.insert(known.end(), names.begin(), names.end());
  const Map by_tag = value->map(known, "tag or key");
  for (const Map::Entry& entry : by_tag.entries()) {
    const auto index =
        static_cast<std::size_t>(std::find(tags.begin(), tags.end(), entry.key) - tags.begin());
    if (index == tags.size()) {
      entry.key_at.error("give it for all at once or below each tag, not both");
    } else {
      read_fields(entry.value.map(names), fields, settings[index]);
    }
  }
}

void read_limits(const Map& map, const UnitConfig& config, SimulationSettings& simulation) {
  const Value* value = map.find("limits");
  if (value == nullptr) return;
  std::vector<std::string> tags;
  for (const InputSignal& mv : config.mv) tags.push_back(mv.tag);
  for (const CvSignal& cv : config.cv) tags.push_back(cv.tag);
  const Map by_tag = value->map(tags, "mv or cv");
  for (const Map::Entry& entry : by_tag.entries()) {
    const auto index =
        static_cast<std::size_t>(std::find(tags.begin(), tags.end(), entry.key) - tags.begin());
    if (index < config.mv.size()) {
      const Map limits = entry.value.map({"low", "high", "max_move"});
      read_low_high(limits, simulation.mv_limits[index]);
      if (const Value* move = limits.find("max_move"))
        simulation.mv_limits[index].max_move = move->number(kPositive);
    } else {
      read_low_high(entry.value.map({"low", "high"}),
                    simulation.cv_limits[index - config.mv.size()]);
    }
  }
}

void read_move_blocks(const Map& map, SimulationSettings& simulation) {
  if (const Value* blocks = map.find("move_blocks")) {
    simulation.move_blocks.clear();
    for (const Value& item : blocks->items())
      simulation.move_blocks.push_back(item.integer({.low = 1, .high = 10000}).value_or(1));
    if (simulation.move_blocks.empty()) blocks->error("must not be empty");
  }
  const auto& blocks = simulation.move_blocks;
  const long total = std::accumulate(blocks.begin(), blocks.end(), 0L);
  if (total <= simulation.prediction_horizon) return;
  const Value* place =
      map.find("move_blocks") != nullptr ? map.find("move_blocks") : map.find("prediction_horizon");
  if (place != nullptr)
    place->error("the move_blocks add up to " + std::to_string(total) +
                 " samples, more than prediction_horizon");
}

}  // namespace

void load_simulation(const Value* section, UnitConfig& config) {
  SimulationSettings& simulation = config.simulation;
  simulation.cv_weights.assign(config.cv.size(), 1.0);
  simulation.move_weights.assign(config.mv.size(), 1.0);
  simulation.mv_limits.resize(config.mv.size());
  simulation.cv_limits.resize(config.cv.size());
  simulation.noise.resize(config.cv.size());
  simulation.dv_movement.resize(config.dv.size());
  simulation.aux_movement.resize(config.aux.size());
  simulation.setpoints.resize(config.cv.size());
  if (section == nullptr) return;

  std::vector<std::string> known = keys(simulation_fields());
  for (const char* key : {"process", "move_blocks", "cv_weights", "move_weights", "limits", "noise",
                          "dv_movement", "aux_movement", "setpoints"})
    known.emplace_back(key);
  const Map map = section->map(known);
  read_fields(map, simulation_fields(), simulation);
  if (const Value* process = map.find("process")) simulation.process = process->text().value_or("");
  read_move_blocks(map, simulation);
  std::vector<std::string> mvs, dvs, auxiliaries;
  for (const InputSignal& mv : config.mv) mvs.push_back(mv.tag);
  for (const InputSignal& dv : config.dv) dvs.push_back(dv.tag);
  for (const InputSignal& aux : config.aux) auxiliaries.push_back(aux.tag);
  const std::vector<std::string> cvs = config.cv_tags();
  read_weights(map, "cv_weights", cvs, simulation.cv_weights);
  read_weights(map, "move_weights", mvs, simulation.move_weights);
  read_limits(map, config, simulation);
  read_each(map, "noise", cvs, noise_fields(), simulation.noise);
  read_each(map, "dv_movement", dvs, noise_fields(), simulation.dv_movement);
  read_each(map, "aux_movement", auxiliaries, noise_fields(), simulation.aux_movement);
  read_each(map, "setpoints", cvs, setpoint_fields(), simulation.setpoints);
}

}  // namespace mpm::config
