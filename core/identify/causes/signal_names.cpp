#include "core/identify/causes/signal_names.hpp"

#include <cmath>

#include "core/identify/causes/cause.hpp"
#include "core/model/linear_model.hpp"
#include "core/text/number_text.hpp"

namespace mpm {
namespace {

std::string with_unit(double value, const std::string& unit) {
  return number_text(value) + (unit.empty() ? "" : " " + unit);
}

}  // namespace

const SignalName& SignalNames::input(int index) const {
  return inputs.at(static_cast<std::size_t>(index));
}

const SignalName& SignalNames::cv(int index) const {
  return cvs.at(static_cast<std::size_t>(index));
}

const SignalName& SignalNames::source(const Place& place) const {
  static const SignalName none;
  if (place.aux >= 0) return aux.at(static_cast<std::size_t>(place.aux));
  return place.input >= 0 ? input(place.input) : none;
}

std::string SignalNames::subject(const Subject& subject) const {
  const Cause& cause = *subject.cause;
  std::string text = cause.name().text;
  if (*cause.kind() != '\0') text += std::string(" (") + cause.kind() + ")";
  const std::string& from = source(subject.place).tag;
  if (subject.place.cv < 0) return from.empty() ? text : text + " of " + from;
  return text + (from.empty() ? " on " : " of " + from + " -> ") + cv(subject.place.cv).tag;
}

std::string SignalNames::in_cv(double value, int index) const {
  return with_unit(value, cv(index).unit);
}

std::string SignalNames::in_source(double value, const Place& place) const {
  return with_unit(value, source(place).unit);
}

std::string SignalNames::unit_text(Unit unit, const Place& place) const {
  switch (unit) {
    case Unit::kOfModel:
      return "x model";
    case Unit::kSeconds:
      return "s";
    case Unit::kCv:
      return place.cv >= 0 ? cv(place.cv).unit : "";
    case Unit::kCvPerSecond:
      return place.cv >= 0 ? cv(place.cv).unit + "/s" : "";
    case Unit::kInput:
      return source(place).unit;
    case Unit::kCvPerInput: {
      const std::string& per = source(place).unit;
      return place.cv < 0 || per.empty() ? "" : cv(place.cv).unit + " per " + per;
    }
    case Unit::kNone:
      break;
  }
  return {};
}

std::string SignalNames::gains(const Place& place, double ratio) const {
  if (place.cv < 0 || place.input < 0 || place.input >= model.input_count) return {};
  const LinearModel simulator(model);
  const double gain = simulator.steady_gain()(place.cv, place.input);
  if (gain == 0.0 || simulator.integrating()(place.cv, place.input)) return {};
  const std::string unit = unit_text(Unit::kCvPerInput, place);
  return "gain " + number_text(ratio * gain) + " instead of " + number_text(gain) +
         (unit.empty() ? "" : " " + unit) + "; ";
}

std::string interval_of(const Parameter& parameter, const std::string& unit) {
  return "95 % interval " + interval_text(parameter.low, parameter.high) +
         (unit.empty() ? "" : " " + unit);
}

std::string compared(double ratio) {
  if (ratio < 0.0) return "in the opposite direction and " + number_text(-ratio) + " times as much";
  return percent_text(std::abs(ratio - 1.0)) + (ratio < 1.0 ? " less" : " more");
}

}  // namespace mpm
