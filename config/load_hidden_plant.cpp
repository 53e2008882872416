#include <algorithm>

#include "config/load_model_parts.hpp"
#include "config/load_scenario_parts.hpp"

namespace mpm::config {
namespace {

/// As the unit's, with the aux signals behind the DVs: in the plant these may act as well.
ModelSignals plant_signals(const UnitConfig& unit) {
  ModelSignals signals = signals_of(unit);
  for (const InputSignal& aux : unit.aux) signals.inputs.push_back(aux.tag);
  const auto inputs = static_cast<Eigen::Index>(signals.inputs.size());
  Eigen::VectorXd origin = Eigen::VectorXd::Zero(inputs);
  origin.head(signals.input_origin.size()) = signals.input_origin;
  signals.input_origin = std::move(origin);
  signals.input_noun = "mv, dv or aux";
  return signals;
}

void check_aux_moves(const Value& list, const UnitConfig& unit, const HiddenPlant& plant) {
  for (const ChannelSpec& channel : plant.channels) {
    const int aux = channel.input - unit.model.input_count;
    if (aux >= 0 && unit.simulation.aux_movement[static_cast<std::size_t>(aux)].sigma == 0.0)
      list.error("'" + unit.aux[static_cast<std::size_t>(aux)].tag +
                 "' stands still: give it a sigma in the unit file's simulation.aux_movement");
  }
}

}  // namespace

void load_hidden_plant(const Value& section, const ScenarioContext& context,
                       ScenarioConfig& scenario) {
  const UnitConfig& unit = context.unit;
  const Map map = section.map({"input", "output", "channels", "state"});
  HiddenPlant& plant = scenario.plant;
  plant.place = {section.file(), section.line(), section.column(), section.path()};
  plant.input_blocks.resize(static_cast<std::size_t>(unit.model.input_count));
  plant.output_blocks.resize(unit.cv.size());
  if (const Value* blocks = map.find("input"))
    read_input_blocks(*blocks, unit.input_tags(), plant.input_blocks);
  if (const Value* blocks = map.find("output"))
    read_output_blocks(*blocks, unit.cv_tags(), plant.output_blocks);
  for (const char* key : {"channels", "state"})
    if (map.find(key) != nullptr && unit.model.state_space)
      map.entry(key)->key_at.error("needs a unit whose model has channels, not a state space");
  if (unit.model.state_space) return;
  const ModelSignals signals = plant_signals(unit);
  if (const Value* list = map.find("channels"); list != nullptr && !list->is_null()) {
    plant.channels = read_channels(*list, signals);
    check_aux_moves(*list, unit, plant);
  }
  if (const Value* list = map.find("state"); list != nullptr && !list->is_null())
    plant.state_terms = read_state_terms(*list, signals, plant.over(unit.model.channels));
}

std::vector<ChannelSpec> HiddenPlant::over(const std::vector<ChannelSpec>& known) const {
  std::vector<ChannelSpec> all = known;
  for (const ChannelSpec& channel : channels) {
    const auto same = std::find_if(all.begin(), all.end(), [&channel](const ChannelSpec& other) {
      return other.cv == channel.cv && other.input == channel.input;
    });
    if (same != all.end())
      *same = channel;
    else
      all.push_back(channel);
  }
  return all;
}

bool HiddenPlant::empty() const {
  const auto none = [](const auto& block) { return !block.has_value(); };
  return std::all_of(input_blocks.begin(), input_blocks.end(), none) &&
         std::all_of(output_blocks.begin(), output_blocks.end(), none) && channels.empty() &&
         state_terms.empty();
}

}  // namespace mpm::config
