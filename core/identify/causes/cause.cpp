#include "core/identify/causes/cause.hpp"

#include <algorithm>
#include <cmath>

#include "core/identify/causes/priors.hpp"

namespace mpm {

std::vector<int> Outlook::cvs_of(int input) const {
  std::vector<int> cvs;
  for (const ChannelSpec& channel : model().channels)
    if (channel.input == input) cvs.push_back(channel.cv);
  return cvs;
}

void Cause::propose(const Outlook&, std::vector<Effect>&) const {}

std::vector<Effect> Cause::shown_by(const Problem&) const { return {}; }

bool Cause::goes_with(const Effect& accepted, const Effect& mine) const {
  const Cause& other = cause_of(accepted);
  if (&other.name() == &name_ && accepted.place == mine.place) return false;
  return !(other.settles_channel(accepted) && accepted.place.cv == mine.place.cv &&
           accepted.place.input == mine.place.input);
}

bool Cause::settles_channel(const Effect&) const { return false; }

double Cause::rarity() const { return kUsualRarity; }

bool Cause::borne_out(const Effect&, const Problem&) const { return false; }
bool Cause::contradicted(const Effect&, const Problem&) const { return false; }

std::optional<bool> Cause::matters(const Effect&, const Tolerances&) const { return std::nullopt; }

std::vector<Effect> Cause::closer_look(const Effect&, const std::vector<Effect>&) const {
  return {};
}

Stepping Cause::stepping(const Effect&) const { return {}; }

Effect Cause::neighbour(const Effect& mine, double, int, const Problem&) const { return mine; }

std::vector<Rewrite> Cause::rewrites(std::size_t, const std::vector<Effect>&, const Problem&,
                                     const Tolerances&) const {
  return {};
}

std::vector<Finding> Cause::left_in(const Problem&, const Fit&) const { return {}; }

bool Cause::may_be_nothing(const Finding& finding) const {
  return !finding.parameters.empty() && includes_nothing(finding.parameters.front());
}

void Cause::restate(const Effect&, const Problem&, Finding&) const {}

Effect Cause::effect(const Place& place, std::vector<Coordinate> coordinates, double search_cost,
                     Eigen::Index onset) const {
  Effect effect;
  effect.edit = this;
  effect.place = place;
  effect.coordinates = std::move(coordinates);
  effect.search_cost = search_cost;
  effect.onset = onset;
  return effect;
}

const Cause& cause_of(const Effect& effect) { return static_cast<const Cause&>(*effect.edit); }

Subject subject_of(const Effect& effect) { return {&cause_of(effect), effect.place}; }

double cost_of(std::size_t alternatives) {
  return 2.0 * std::log(static_cast<double>(std::max<std::size_t>(1, alternatives)));
}

}  // namespace mpm
