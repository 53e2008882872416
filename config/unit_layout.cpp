#include "config/unit_layout.hpp"

#include <algorithm>
#include <utility>

namespace mpm::config {
namespace {

template <class Signals, class Field>
std::vector<std::string> each(const Signals& signals, Field field) {
  std::vector<std::string> texts;
  texts.reserve(signals.size());
  for (const auto& signal : signals) texts.push_back(signal.*field);
  return texts;
}

}  // namespace

std::vector<std::string> tags_of(const UnitConfig& unit, SignalKind kind) {
  switch (kind) {
    case SignalKind::kMv:
      return each(unit.mv, &InputSignal::tag);
    case SignalKind::kDv:
      return each(unit.dv, &InputSignal::tag);
    case SignalKind::kAux:
      return each(unit.aux, &InputSignal::tag);
    case SignalKind::kRaw:
      return each(unit.raw, &InputSignal::tag);
    case SignalKind::kCv:
      return each(unit.cv, &CvSignal::tag);
    case SignalKind::kPrediction:
      return each(unit.cv, &CvSignal::prediction);
    case SignalKind::kSetpoint:
      return each(unit.cv, &CvSignal::setpoint);
  }
  return {};
}

std::vector<std::string> engineering_units_of(const UnitConfig& unit, SignalKind kind) {
  switch (kind) {
    case SignalKind::kMv:
      return each(unit.mv, &InputSignal::unit);
    case SignalKind::kDv:
      return each(unit.dv, &InputSignal::unit);
    case SignalKind::kAux:
      return each(unit.aux, &InputSignal::unit);
    case SignalKind::kRaw:
      return each(unit.raw, &InputSignal::unit);
    default:
      return each(unit.cv, &CvSignal::unit);
  }
}

std::vector<std::string> measured_tags_of(const UnitConfig& unit, SignalKind kind) {
  std::vector<std::string> tags = tags_of(unit, kind);
  for (std::string& tag : tags)
    if (unit.calculation_of(tag) != nullptr) tag.clear();
  return tags;
}

std::vector<std::pair<std::string, std::uint64_t>> by_tag(const UnitConfig& unit,
                                                          const SignalTally& counts) {
  std::vector<std::pair<std::string, std::uint64_t>> tags;
  for (std::size_t kind = 0; kind < kSignalKindCount; ++kind) {
    const std::vector<std::string> names = tags_of(unit, static_cast<SignalKind>(kind));
    for (std::size_t i = 0; i < counts[kind].size(); ++i)
      if (counts[kind][i] > 0) tags.emplace_back(names[i], counts[kind][i]);
  }
  return tags;
}

bool is_layout_of(const UnitConfig& unit, SignalKind kind, const std::vector<std::string>& tags) {
  const std::vector<std::string> all = tags_of(unit, kind);
  const std::vector<std::string> measured = measured_tags_of(unit, kind);
  if (tags.size() != all.size()) return false;
  for (std::size_t i = 0; i < tags.size(); ++i)
    if (tags[i] != all[i] && tags[i] != measured[i]) return false;
  return true;
}

UnitLayout unit_layout(const UnitConfig& unit) {
  UnitLayout layout;
  layout.unit = unit.unit;
  layout.sample_time_s = unit.sample_time_s;
  for (const SignalKind kind : {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv,
                                SignalKind::kPrediction, SignalKind::kSetpoint, SignalKind::kRaw}) {
    std::vector<std::string> tags = measured_tags_of(unit, kind);
    if (std::all_of(tags.begin(), tags.end(), [](const std::string& tag) { return tag.empty(); }))
      continue;
    layout[kind] = {std::move(tags), engineering_units_of(unit, kind)};
  }
  return layout;
}

}  // namespace mpm::config
