#include "daemon/recording/unit_tags.hpp"

#include "idl/topics.hpp"

namespace mpm::recording {
namespace {

template <class Signals, class Field>
std::vector<std::string> each(const Signals& signals, Field field) {
  std::vector<std::string> texts;
  texts.reserve(signals.size());
  for (const auto& signal : signals) texts.push_back(signal.*field);
  return texts;
}

}  // namespace

std::vector<std::string> tags_of(const config::UnitConfig& unit, SignalKind kind) {
  switch (kind) {
    case SignalKind::kMv:
      return each(unit.mv, &config::InputSignal::tag);
    case SignalKind::kDv:
      return each(unit.dv, &config::InputSignal::tag);
    case SignalKind::kAux:
      return each(unit.aux, &config::InputSignal::tag);
    case SignalKind::kCv:
      return each(unit.cv, &config::CvSignal::tag);
    case SignalKind::kPrediction:
      return each(unit.cv, &config::CvSignal::prediction);
    case SignalKind::kSetpoint:
      return each(unit.cv, &config::CvSignal::setpoint);
  }
  return {};
}

std::vector<std::string> engineering_units_of(const config::UnitConfig& unit, SignalKind kind) {
  switch (kind) {
    case SignalKind::kMv:
      return each(unit.mv, &config::InputSignal::unit);
    case SignalKind::kDv:
      return each(unit.dv, &config::InputSignal::unit);
    case SignalKind::kAux:
      return each(unit.aux, &config::InputSignal::unit);
    default:
      return each(unit.cv, &config::CvSignal::unit);
  }
}

const char* name_of(SignalKind kind) {
  return kind == SignalKind::kAux ? "aux" : idl::kind_name(kind);
}

}  // namespace mpm::recording
