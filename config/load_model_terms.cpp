#include <algorithm>
#include <stdexcept>

#include "config/load_model_parts.hpp"
#include "config/time_text.hpp"
#include "core/model/linear_model.hpp"

namespace mpm::config {
namespace {

const std::vector<std::string> kTerms = {"restoring_force", "square_root_outflow",
                                         "coulomb_friction"};

double read_number(const Map& map, std::string_view key, const Range& range, double otherwise) {
  const Value* value = map.find(key);
  return value != nullptr ? value->number(range).value_or(otherwise) : otherwise;
}

double require_number(const Map& map, std::string_view key, const Range& range, double otherwise) {
  const Value* value = map.require(key);
  return value != nullptr ? value->number(range).value_or(otherwise) : otherwise;
}

StateBlock read_block(const Map::Entry& entry) {
  if (entry.key == "restoring_force") {
    const Map map = entry.value.map({"quadratic", "cubic"});
    if (map.entries().empty()) entry.value.error("give `quadratic`, `cubic` or both");
    return RestoringForce{read_number(map, "quadratic", kAny, 0.0),
                          read_number(map, "cubic", kAny, 0.0)};
  }
  if (entry.key == "square_root_outflow") {
    const Map map = entry.value.map({"empty_output"});
    return SquareRootOutflow{require_number(map, "empty_output", kAny, 0.0)};
  }
  const Map map = entry.value.map({"force", "speed"});
  return CoulombFriction{require_number(map, "force", kNotNegative, 0.0),
                         require_number(map, "speed", kPositive, 1.0)};
}

/// Why the channel cannot bear the term, as the simulator says it; nothing where it can, or where
/// the channel alone is wrong already.
std::optional<std::string> why_not(const StateTerm& term, const ChannelSpec& channel,
                                   const ModelSignals& signals) {
  ModelSpec model;
  model.sample_time_s = signals.sample_time_s;
  model.input_count = static_cast<int>(signals.inputs.size());
  model.cv_count = static_cast<int>(signals.cvs.size());
  model.input_origin = signals.input_origin;
  model.output_origin = signals.output_origin;
  model.channels.push_back(channel);
  try {
    const LinearModel without(model);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  model.state_terms.push_back(term);
  try {
    const LinearModel with(model);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return std::nullopt;
}

std::vector<std::string> own_keys(DisturbanceShape shape) {
  switch (shape) {
    case DisturbanceShape::kStep:
      return {"time_constant", "decay", "until"};
    case DisturbanceShape::kDrift:
      return {"until"};
    case DisturbanceShape::kPeriodic:
      return {"period", "wave"};
  }
  return {};
}

std::optional<DisturbanceShape> read_shape(const Map& map) {
  const Value* value = map.require("shape");
  if (value == nullptr) return std::nullopt;
  const std::string name = value->is_scalar() ? value->free_text().value_or("") : "";
  for (const Choice<DisturbanceShape>& choice : choices(DisturbanceShape{})) {
    if (name != choice.name) continue;
    const std::vector<std::string> own = own_keys(choice.kind);
    for (const char* key : {"time_constant", "decay", "period", "wave", "until"})
      if (map.entry(key) != nullptr && std::find(own.begin(), own.end(), key) == own.end())
        map.entry(key)->key_at.error("does not go with the shape " + name);
    return choice.kind;
  }
  value->error("must be step, drift or periodic");
  return std::nullopt;
}

std::optional<DisturbanceTerm> read_disturbance(const Value& item, const ModelSignals& signals) {
  const Map map = item.map(
      {"cv", "shape", "onset", "size", "time_constant", "decay", "period", "wave", "until"});
  const std::optional<DisturbanceShape> shape = read_shape(map);
  if (!shape) return std::nullopt;
  DisturbanceTerm term;
  term.shape = *shape;
  if (const Value* cv = map.require("cv")) term.cv = find_tag(*cv, signals.cvs, "cv");
  term.size = require_number(map, "size", kAny, 0.0);
  const bool periodic = *shape == DisturbanceShape::kPeriodic;
  const Value* onset = periodic ? map.find("onset") : map.require("onset");
  if (onset != nullptr) term.onset_s = read_clock(*onset).value_or(0.0);
  term.time_constant_s = read_number(map, "time_constant", kNotNegative, 0.0);
  term.decay_s = read_number(map, "decay", kPositive, term.decay_s);
  if (periodic) term.period_s = require_number(map, "period", kPositive, 1.0);
  if (const Value* wave = map.find("wave")) {
    const std::string name = wave->is_scalar() ? wave->free_text().value_or("") : "";
    if (name != "sine" && name != "square") wave->error("must be sine or square");
    term.square = name == "square";
  }
  if (const Value* until = map.find("until")) {
    if (const std::optional<double> end = read_clock(*until)) {
      if (*end > term.onset_s)
        term.until_s = *end;
      else
        until->error("must be after `onset`");
    }
  }
  if (term.cv < 0) return std::nullopt;
  return term;
}

}  // namespace

std::optional<double> read_clock(const Value& value) {
  const std::string text = value.is_scalar() ? value.free_text().value_or("") : "";
  // The dash behind a year; a number may have one there behind its e only.
  const bool is_date = text.size() > 4 && text[4] == '-' && text.find('e') == std::string::npos;
  if (!is_date) return value.number({.low = -9e9, .high = 9e9});
  const std::optional<std::int64_t> time_ns = parse_time(text);
  if (!time_ns) {
    value.error("must be seconds or ISO 8601 with a zone, such as 2024-05-01T12:00:00Z, not '" +
                text + "'");
    return std::nullopt;
  }
  constexpr std::int64_t kSecond = 1000000000;
  const std::int64_t whole = *time_ns / kSecond;  // apart, so that no digit of the rest is lost
  return static_cast<double>(whole) + 1e-9 * static_cast<double>(*time_ns % kSecond);
}

std::vector<StateTerm> read_state_terms(const Value& list, const ModelSignals& signals,
                                        const std::vector<ChannelSpec>& channels) {
  std::vector<StateTerm> terms;
  std::vector<std::string> known = {"cv", "mv", "dv"};
  known.insert(known.end(), kTerms.begin(), kTerms.end());
  for (const Value& item : list.items()) {
    const Map map = item.map(known);
    const ChannelPlace place = read_place(map, signals);
    std::vector<const Map::Entry*> given;
    for (const Map::Entry& entry : map.entries())
      if (std::find(kTerms.begin(), kTerms.end(), entry.key) != kTerms.end())
        given.push_back(&entry);
    if (given.empty())
      item.error("needs `restoring_force`, `square_root_outflow` or `coulomb_friction`");
    for (std::size_t i = 1; i < given.size(); ++i)
      given[i]->key_at.error("does not go with `" + given[0]->key + "` in one term");
    if (given.empty()) continue;
    const StateTerm term{place.cv, place.input, read_block(*given[0])};
    if (!place.known()) continue;
    const auto is_its = [&place](const auto& other) {
      return other.cv == place.cv && other.input == place.input;
    };
    const auto channel = std::find_if(channels.begin(), channels.end(), is_its);
    if (channel == channels.end()) {
      item.error("there is no channel from '" +
                 signals.inputs[static_cast<std::size_t>(place.input)] + "' to '" +
                 signals.cvs[static_cast<std::size_t>(place.cv)] + "' for it to act in");
    } else if (std::any_of(terms.begin(), terms.end(), is_its)) {
      item.error("a second term in this channel");
    } else if (const auto reason = why_not(term, *channel, signals)) {
      item.error(*reason);
    } else {
      terms.push_back(term);
    }
  }
  return terms;
}

std::vector<DisturbanceTerm> read_disturbances(const Value& list, const ModelSignals& signals) {
  std::vector<DisturbanceTerm> terms;
  for (const Value& item : list.items())
    if (const auto term = read_disturbance(item, signals)) terms.push_back(*term);
  return terms;
}

}  // namespace mpm::config
