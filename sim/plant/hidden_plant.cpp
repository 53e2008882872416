#include "sim/plant/hidden_plant.hpp"

#include <algorithm>

namespace mpm::sim {
namespace {

template <class Block>
void put_over(const std::vector<std::optional<Block>>& hidden,
              std::vector<std::optional<Block>>& blocks) {
  blocks.resize(std::max(blocks.size(), hidden.size()));
  for (std::size_t i = 0; i < hidden.size(); ++i)
    if (hidden[i]) blocks[i] = hidden[i];
}

void add_aux_inputs(const config::UnitConfig& unit, ModelSpec& plant) {
  const auto count = static_cast<int>(unit.aux.size());
  Eigen::VectorXd origin = Eigen::VectorXd::Zero(plant.input_count + count);
  if (plant.input_origin.size() != 0) origin.head(plant.input_count) = plant.input_origin;
  plant.input_origin = std::move(origin);
  plant.input_count += count;
  plant.input_blocks.resize(static_cast<std::size_t>(plant.input_count));
}

}  // namespace

ModelSpec plant_model(const config::UnitConfig& unit, const config::HiddenPlant& hidden) {
  ModelSpec plant = unit.model;
  if (hidden.empty()) return plant;
  put_over(hidden.input_blocks, plant.input_blocks);
  put_over(hidden.output_blocks, plant.output_blocks);
  const bool aux_acts = std::any_of(
      hidden.channels.begin(), hidden.channels.end(),
      [&unit](const ChannelSpec& channel) { return channel.input >= unit.model.input_count; });
  if (aux_acts) add_aux_inputs(unit, plant);
  plant.channels = hidden.over(plant.channels);
  for (const StateTerm& term : hidden.state_terms) {
    const auto same = std::find_if(plant.state_terms.begin(), plant.state_terms.end(),
                                   [&term](const StateTerm& other) {
                                     return other.cv == term.cv && other.input == term.input;
                                   });
    if (same != plant.state_terms.end())
      *same = term;
    else
      plant.state_terms.push_back(term);
  }
  return plant;
}

}  // namespace mpm::sim
