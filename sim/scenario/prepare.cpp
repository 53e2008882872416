#include "sim/scenario/prepare.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "sim/plant/hidden_plant.hpp"
#include "sim/scenario/random_change.hpp"
#include "sim/scenario/stability.hpp"

namespace mpm::sim {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// For each of `wanted` its place in `given`.
std::vector<Index> places(const std::vector<std::string>& wanted,
                          const std::vector<std::string>& given) {
  for (const std::string& tag : given)
    if (std::find(wanted.begin(), wanted.end(), tag) == wanted.end())
      throw std::invalid_argument("the controller's model uses '" + tag +
                                  "', which the plant does not have");
  std::vector<Index> result;
  for (const std::string& tag : wanted) {
    const auto place = std::find(given.begin(), given.end(), tag);
    if (place == given.end())
      throw std::invalid_argument("the controller's model lacks '" + tag + "'");
    result.push_back(place - given.begin());
  }
  return result;
}

template <class Item>
std::vector<Item> reordered(const std::vector<Item>& items, const std::vector<Index>& order) {
  if (items.empty()) return {};
  std::vector<Item> result;
  result.reserve(order.size());
  for (const Index place : order) result.push_back(items[static_cast<std::size_t>(place)]);
  return result;
}

VectorXd reordered(const VectorXd& items, const std::vector<Index>& order) {
  if (items.size() == 0) return items;
  return items(order);
}

int position_of(Index place, const std::vector<Index>& order) {
  return static_cast<int>(std::find(order.begin(), order.end(), place) - order.begin());
}

std::vector<std::string> mv_tags(const config::UnitConfig& unit) {
  std::vector<std::string> tags = unit.input_tags();
  tags.resize(unit.mv.size());
  return tags;
}

/// Why the plant with the changes so far cannot be made or run.
std::optional<std::string> why_not(const LoopSetup& setup) {
  const config::UnitConfig& unit = setup.unit;
  try {
    if (!unit.simulation.process.empty()) {
      static_cast<void>(make_process(setup));
      return std::nullopt;
    }
    const std::vector<PlantStage> stages =
        plant_stages(plant_model(unit, setup.scenario.plant), setup.changes);
    if (feedback_share(setup.scenario) != 1.0 || setup.scenario.allow_unstable) return std::nullopt;
    return why_not_stabilisable(setup.controller_model, stages, static_cast<int>(unit.mv.size()),
                                unit.simulation.cv_weights);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

/// Of what is hidden in the plant, or of the first change with which, and with those before it, the
/// plant is too much.
config::Place place_to_blame(LoopSetup setup) {
  for (const config::ProcessChange& change : std::exchange(setup.scenario.process, {})) {
    LoopSetup alone = setup;
    alone.scenario.process = {change};
    if (!why_not(setup) && why_not(alone)) return change.place;
  }
  setup.changes.clear();
  if (why_not(setup)) return setup.scenario.plant.place;  // already without a change
  for (const config::Change& change : setup.scenario.changes) {
    const std::vector<ChannelChange> resolved = resolve_changes({change}, setup.unit);
    setup.changes.insert(setup.changes.end(), resolved.begin(), resolved.end());
    if (why_not(setup)) return change.place;
  }
  return {};
}

}  // namespace

ModelSpec match_signals(const config::UnitConfig& controller, const config::UnitConfig& plant) {
  if (!controller.has_model()) throw std::invalid_argument("the controller's unit has no model");
  if (controller.sample_time_s != plant.sample_time_s)
    throw std::invalid_argument("the controller's model has another sample time than the plant");
  static_cast<void>(places(mv_tags(plant), mv_tags(controller)));  // an MV must stay an MV
  const std::vector<Index> inputs = places(plant.input_tags(), controller.input_tags());
  const std::vector<Index> cvs = places(plant.cv_tags(), controller.cv_tags());

  const ModelSpec& given = controller.model;
  ModelSpec model = given;
  for (ChannelSpec& channel : model.channels) {
    channel.cv = position_of(channel.cv, cvs);
    channel.input = position_of(channel.input, inputs);
  }
  for (StateTerm& term : model.state_terms) {
    term.cv = position_of(term.cv, cvs);
    term.input = position_of(term.input, inputs);
  }
  for (DisturbanceTerm& disturbance : model.disturbances)
    disturbance.cv = position_of(disturbance.cv, cvs);
  if (model.state_space) {
    model.state_space->b = given.state_space->b(Eigen::all, inputs);
    model.state_space->c = given.state_space->c(cvs, Eigen::all);
    model.state_space->d = given.state_space->d(cvs, inputs);
  }
  model.input_blocks = reordered(given.input_blocks, inputs);
  model.output_blocks = reordered(given.output_blocks, cvs);
  model.input_origin = reordered(given.input_origin, inputs);
  model.output_origin = reordered(given.output_origin, cvs);
  return model;
}

RefusedScenario::RefusedScenario(const config::Place& place, const std::string& scenario,
                                 const std::string& reason)
    : std::invalid_argument(reason),
      finding_{place.file,   place.line,
               place.column, config::Severity::kError,
               place.key,    place.line > 0 ? reason : "scenario '" + scenario + "': " + reason} {}

void hide_changes(LoopSetup& setup) {
  const config::ScenarioConfig& scenario = setup.scenario;
  setup.changes = resolve_changes(scenario.changes, setup.unit);
  if (const std::optional<std::string> reason = why_not(setup))
    throw RefusedScenario(place_to_blame(setup), scenario.name, *reason);
  const std::optional<std::vector<ChannelChange>> drawn = draw_changes(setup);
  if (!drawn)
    throw RefusedScenario(scenario.draw ? scenario.draw->place : config::Place{}, scenario.name,
                          "too few channels can bear what the scenario draws from");
  setup.changes.insert(setup.changes.end(), drawn->begin(), drawn->end());
}

}  // namespace mpm::sim
