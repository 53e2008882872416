#include "daemon/report/diagnosis/signal_names.hpp"

#include "daemon/report/diagnosis/number_text.hpp"

namespace mpm::report {
namespace {

std::string with_unit(double value, const std::string& unit) {
  return number_text(value) + (unit.empty() ? "" : " " + unit);
}

}  // namespace

const std::string& SignalNames::cv(int index) const {
  return unit_.cv.at(static_cast<std::size_t>(index)).tag;
}

const config::InputSignal& SignalNames::input_signal(int index) const {
  auto i = static_cast<std::size_t>(index);
  if (i < unit_.mv.size()) return unit_.mv[i];
  i -= unit_.mv.size();
  if (i < unit_.dv.size()) return unit_.dv[i];
  i -= unit_.dv.size();
  return unit_.aux.at(static_cast<std::size_t>(new_inputs_.at(i)));
}

const std::string& SignalNames::input(int index) const { return input_signal(index).tag; }

const std::string& SignalNames::aux(int index) const {
  return unit_.aux.at(static_cast<std::size_t>(index)).tag;
}

std::string SignalNames::source(const Subject& subject) const {
  if (subject.aux >= 0) return aux(subject.aux);
  return subject.input >= 0 ? input(subject.input) : std::string();
}

std::string SignalNames::subject(const Subject& subject) const {
  std::string text = name_of(subject.cause);
  if (!subject.kind.empty()) text += " (" + subject.kind + ")";
  const std::string from = source(subject);
  if (subject.cv < 0) return from.empty() ? text : text + " of " + from;
  return text + (from.empty() ? " on " : " of " + from + " -> ") + cv(subject.cv);
}

const std::string& SignalNames::cv_unit(int index) const {
  return unit_.cv.at(static_cast<std::size_t>(index)).unit;
}

const std::string& SignalNames::source_unit(const Subject& subject) const {
  static const std::string kNone;
  if (subject.aux >= 0) return unit_.aux.at(static_cast<std::size_t>(subject.aux)).unit;
  return subject.input >= 0 ? input_signal(subject.input).unit : kNone;
}

std::string SignalNames::in_cv(double value, int cv) const { return with_unit(value, cv_unit(cv)); }

std::string SignalNames::in_source(double value, const Subject& subject) const {
  return with_unit(value, source_unit(subject));
}

}  // namespace mpm::report
