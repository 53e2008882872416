#include <limits>

#include "config/load_model_parts.hpp"
#include "config/yaml_text.hpp"

namespace mpm::config {
namespace {

constexpr std::size_t kMostTanks = 50;
constexpr double kMostDelaySamples = 100000.0;

/// A relative level above that of the operating point, or `.inf`.
std::optional<double> read_overflow(const Value& value) {
  if (value.is_scalar() && value.free_text() == ".inf")
    return std::numeric_limits<double>::infinity();
  return value.number({.low = 1.0, .low_open = true});
}

/// A number that is not the operating point's, which it would leave without flow or level.
double read_empty(const Map& map, std::string_view key, const std::vector<std::string>& tags,
                  const Eigen::VectorXd& origin, int index) {
  const Value* value = map.require(key);
  const double empty = value != nullptr ? value->number().value_or(0.0) : 0.0;
  if (value != nullptr && index >= 0 && origin(index) == empty)
    value->error("is the operating point of " + tags[static_cast<std::size_t>(index)] + " (" +
                 yaml_text(empty) +
                 "): nothing flows there, so there is nothing to be linear about");
  return empty;
}

}  // namespace

TankChain read_tanks(const Value& value, const ModelSignals& signals, int cv, int input) {
  const Map map = value.map(
      {"time_constants", "empty_input", "empty_output", "overflow", "spill", "dead_time"});
  TankChain tanks;
  if (const Value* constants = map.require("time_constants")) {
    tanks.time_constants_s = constants->numbers(kPositive);
    if (constants->items().empty()) constants->error("needs one number per tank");
    if (tanks.time_constants_s.size() > kMostTanks)
      constants->error("more than " + std::to_string(kMostTanks) + " tanks");
  }
  tanks.empty_input = read_empty(map, "empty_input", signals.inputs, signals.input_origin, input);
  tanks.empty_output = read_empty(map, "empty_output", signals.cvs, signals.output_origin, cv);
  if (const Value* overflow = map.find("overflow")) {
    for (const Value& item : overflow->items())
      if (const auto level = read_overflow(item)) tanks.overflow.push_back(*level);
    const Value* constants = map.find("time_constants");
    const std::size_t expected = constants != nullptr ? constants->items().size() : 0;
    if (overflow->items().size() != expected && expected > 0)
      overflow->error("needs one level per tank (" + std::to_string(expected) + "; .inf = never)");
  }
  if (const Value* spill = map.find("spill"))
    tanks.spill = spill->number({.low = 0.0, .high = 1.0}).value_or(0.0);
  if (const Value* dead_time = map.find("dead_time")) {
    tanks.dead_time_s = dead_time->number(kNotNegative).value_or(0.0);
    if (tanks.dead_time_s > kMostDelaySamples * signals.sample_time_s)
      dead_time->error("is longer than " + yaml_text(kMostDelaySamples) + " samples");
  }
  return tanks;
}

}  // namespace mpm::config
