#include "daemon/files/calculator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "config/unit_layout.hpp"

namespace mpm::files {

Calculator::Calculator(const config::UnitConfig& unit) {
  if (unit.calc.empty()) return;
  std::map<std::string, Place> places;
  for (std::size_t k = 0; k < kSignalKindCount; ++k) {
    const auto kind = static_cast<SignalKind>(k);
    const std::vector<std::string> tags = tags_of(unit, kind);
    for (std::size_t i = 0; i < tags.size(); ++i)
      if (!tags[i].empty()) places[tags[i]] = {kind, static_cast<int>(i)};
  }
  std::map<std::string, std::size_t> calculations;
  for (const config::CalculatedSignal& signal : unit.calc) {
    Step step{config::Formula(signal.expression), {}, {}, {}, {}};
    for (const std::string& tag : step.formula.tags()) {
      Source& source = step.inputs.emplace_back();
      const auto before = calculations.find(tag);
      if (before != calculations.end()) {
        source.calculation = before->second;
        continue;
      }
      const Place& place = places.at(tag);
      source.kind = place.kind;
      source.index = place.index;
    }
    step.values.resize(step.inputs.size());
    const auto place = places.find(signal.tag);
    if (place != places.end()) step.place = place->second;
    calculations[signal.tag] = steps_.size();
    steps_.push_back(std::move(step));
  }
}

Calculator::Value Calculator::value_of(const Source& source, const Frame& frame) const {
  if (source.calculation) return steps_[*source.calculation].result;
  const SignalBlock& block = frame[source.kind];
  return {block.values(source.index), block.quality[static_cast<std::size_t>(source.index)]};
}

void Calculator::fill(Frame& frame) {
  for (Step& step : steps_) {
    Value& result = step.result;
    result.quality = Quality::kGood;
    for (std::size_t i = 0; i < step.inputs.size(); ++i) {
      const Value input = value_of(step.inputs[i], frame);
      step.values[i] = input.value;
      result.quality =
          std::isfinite(input.value) ? std::max(result.quality, input.quality) : Quality::kBad;
      if (result.quality > Quality::kUncertain) break;
    }
    result.value = std::numeric_limits<double>::quiet_NaN();
    if (result.quality <= Quality::kUncertain) result.value = step.formula.evaluate(step.values);
    if (!std::isfinite(result.value)) {
      result.value = std::numeric_limits<double>::quiet_NaN();
      result.quality = Quality::kBad;
    }
    if (!step.place) continue;
    SignalBlock& block = frame[step.place->kind];
    block.values(step.place->index) = result.value;
    block.quality[static_cast<std::size_t>(step.place->index)] = result.quality;
  }
}

}  // namespace mpm::files
