#include "sim/output/model_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>

namespace mpm::sim {
namespace {

using Json = nlohmann::ordered_json;

Json block_json(const Polynomial& block) { return {{"polynomial", block.coefficients}}; }
Json block_json(const Saturation& block) {
  return {{"saturation", Json::array({block.low, block.high})}};
}
Json block_json(const Deadband& block) { return {{"deadband", block.width}}; }
Json block_json(const Stiction& block) {
  return {{"stiction", {{"band", block.band}, {"jump", block.jump}}}};
}
Json since(const char* key, double value, double onset_s) {
  Json json = {{key, value}};
  if (std::isfinite(onset_s)) json["onset"] = onset_s;
  return json;
}
Json block_json(const Stuck& block) {
  return {{"stuck", since("value", block.value, block.onset_s)}};
}
Json block_json(const InputOffset& block) {
  return {{"offset", since("size", block.size, block.onset_s)}};
}
Json block_json(const TwoSided& block) {
  Json sides = {{"above", block.above}, {"below", block.below}};
  if (std::isfinite(block.at)) sides["at"] = block.at;
  return {{"two_sided", std::move(sides)}};
}
Json block_json(const Product& block, const std::vector<std::string>& inputs) {
  Json product = {{"of", inputs[static_cast<std::size_t>(block.of)]}, {"per_unit", block.per_unit}};
  if (block.linear != 1.0) product["linear"] = block.linear;
  return {{"product", std::move(product)}};
}
Json block_json(const Offset& block) { return {{"offset", block.bias}}; }
Json block_json(const Scale& block) { return {{"scale", block.factor}}; }

Json dynamics_json(const TransferFunction& transfer) {
  return {{"gain", transfer.gain},
          {"time_constants", transfer.time_constants_s},
          {"lead", transfer.lead_s},
          {"dead_time", transfer.dead_time_s},
          {"integrating", transfer.integrating}};
}
Json dynamics_json(const DiscreteFilter& filter) {
  return {{"numerator", filter.numerator},
          {"denominator", filter.denominator},
          {"delay_samples", filter.delay_samples}};
}
Json dynamics_json(const StepResponse& response) { return {{"step_response", response.values}}; }
Json dynamics_json(const TankChain& tanks) {
  Json overflow = Json::array();  // null = never
  for (const double level : tanks.overflow)
    overflow.push_back(std::isfinite(level) ? Json(level) : Json(nullptr));
  return {{"tanks",
           {{"time_constants", tanks.time_constants_s},
            {"empty_input", tanks.empty_input},
            {"empty_output", tanks.empty_output},
            {"overflow", overflow},
            {"spill", tanks.spill},
            {"dead_time", tanks.dead_time_s}}}};
}

Json term_json(const RestoringForce& force) {
  return {{"restoring_force", {{"quadratic", force.quadratic}, {"cubic", force.cubic}}}};
}
Json term_json(const SquareRootOutflow& outflow) {
  return {{"square_root_outflow", {{"empty_output", outflow.empty_output}}}};
}
Json term_json(const CoulombFriction& friction) {
  return {{"coulomb_friction", {{"force", friction.force}, {"speed", friction.speed}}}};
}

/// `inputs`: the tags of all.
template <class Block>
Json json_of(const Block& block, const std::vector<std::string>& inputs) {
  return std::visit(
      [&inputs](const auto& kind) {
        if constexpr (std::is_same_v<decltype(kind), const Product&>)
          return block_json(kind, inputs);
        else
          return block_json(kind);
      },
      block);
}

template <class Block>
Json blocks_json(const std::vector<std::optional<Block>>& blocks,
                 const std::vector<std::string>& tags, const std::vector<std::string>& inputs) {
  Json json = Json::object();
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (blocks[i]) json[tags[i]] = json_of(*blocks[i], inputs);
  return json;
}

}  // namespace

Json hidden_plant_json(const config::HiddenPlant& hidden, const config::UnitConfig& unit) {
  std::vector<std::string> inputs = unit.input_tags();
  for (const config::InputSignal& aux : unit.aux) inputs.push_back(aux.tag);
  const std::vector<std::string> cvs = unit.cv_tags();
  const auto place = [&](const auto& item) {
    return Json{{"cv", cvs[static_cast<std::size_t>(item.cv)]},
                {"mv", inputs[static_cast<std::size_t>(item.input)]}};
  };
  Json json = {{"input", blocks_json(hidden.input_blocks, inputs, inputs)},
               {"output", blocks_json(hidden.output_blocks, cvs, inputs)},
               {"channels", Json::array()},
               {"state", Json::array()}};
  for (const ChannelSpec& channel : hidden.channels) {
    Json entry = place(channel);
    entry.update(
        std::visit([](const auto& form) { return dynamics_json(form); }, channel.dynamics));
    if (channel.input_block) entry["input"] = json_of(*channel.input_block, inputs);
    json["channels"].push_back(std::move(entry));
  }
  for (const StateTerm& term : hidden.state_terms) {
    Json entry = place(term);
    entry.update(std::visit([](const auto& block) { return term_json(block); }, term.block));
    json["state"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace mpm::sim
