#include <algorithm>
#include <limits>
#include <utility>

#include "config/load_model_parts.hpp"
#include "config/yaml_text.hpp"

namespace mpm::config {
namespace {

std::optional<Saturation> read_saturation(const Value& value) {
  // What has no limit on one side is written with one of 1e300 (core/identify/causes/priors.hpp).
  constexpr Range kNoLimits{.low = -1e300, .high = 1e300};
  const std::vector<double> limits = value.numbers(kNoLimits);
  if (limits.size() != value.items().size()) return std::nullopt;
  if (limits.size() != 2) {
    value.error("must be [low, high]");
  } else if (limits[0] >= limits[1]) {
    value.error("low must be below high, not [" + yaml_text(limits[0]) + ", " +
                yaml_text(limits[1]) + "]");
  } else {
    return Saturation{limits[0], limits[1]};
  }
  return std::nullopt;
}

std::optional<Stiction> read_stiction(const Value& value) {
  const Map map = value.map({"band", "jump", "slips_once"});
  const Value* band = map.require("band");
  const Value* jump = map.require("jump");
  const auto width = band != nullptr ? band->number(kNotNegative) : std::nullopt;
  const auto slip = jump != nullptr ? jump->number(kNotNegative) : std::nullopt;
  const Value* once = map.find("slips_once");
  const auto slips_once = once != nullptr ? once->boolean() : std::optional<bool>(false);
  if (!width || !slip || !slips_once) return std::nullopt;
  return Stiction{*width, *slip, *slips_once};
}

/// A number from a moment on: `NUMBER`, or `{KEY: NUMBER, onset: TIME}`.
struct Since {
  double value = 0.0;
  double onset_s = -std::numeric_limits<double>::infinity();
};
std::optional<Since> read_since(const Value& value, const char* key) {
  Since since;
  if (value.is_scalar()) {
    const auto number = value.number();
    if (!number) return std::nullopt;
    since.value = *number;
    return since;
  }
  const Map map = value.map({key, "onset"});
  const Value* given = map.require(key);
  const auto number = given != nullptr ? given->number() : std::nullopt;
  if (!number) return std::nullopt;
  since.value = *number;
  if (const Value* onset = map.find("onset")) {
    const auto time = read_clock(*onset);
    if (!time) return std::nullopt;
    since.onset_s = *time;
  }
  return since;
}

std::optional<TwoSided> read_two_sided(const Value& value) {
  const Map map = value.map({"above", "below", "at"});
  TwoSided sides;
  if (map.find("above") == nullptr && map.find("below") == nullptr) {
    value.error("give `above`, `below` or both");
    return std::nullopt;
  }
  for (const auto& [key, into] :
       {std::pair{"above", &sides.above}, {"below", &sides.below}, {"at", &sides.at}}) {
    const Value* given = map.find(key);
    if (given == nullptr) continue;
    const auto number = given->number();
    if (!number) return std::nullopt;
    *into = *number;
  }
  return sides;
}

std::optional<Product> read_product(const Value& value, const std::vector<std::string>& inputs,
                                    int input) {
  const Map map = value.map({"of", "per_unit", "linear"});
  const Value* of = map.require("of");
  const Value* per_unit = map.require("per_unit");
  const Value* linear = map.find("linear");
  const int other = of != nullptr ? find_tag(*of, inputs, "mv or dv") : -1;
  const auto slope = per_unit != nullptr ? per_unit->number() : std::nullopt;
  const auto factor = linear != nullptr ? linear->number() : std::optional<double>(1.0);
  if (other >= 0 && other == input) {
    of->error("is the input itself: what goes with its own place is a `polynomial`");
    return std::nullopt;
  }
  if (other < 0 || !slope || !factor) return std::nullopt;
  return Product{other, *slope, *factor};
}

std::optional<InputBlock> read_input(const Map::Entry& entry,
                                     const std::vector<std::string>& inputs, int input) {
  const Value& value = entry.value;
  if (entry.key == "polynomial") {
    const std::vector<double> c = value.numbers();
    if (value.items().empty()) value.error("needs at least one coefficient");
    if (c.empty() || c.size() != value.items().size()) return std::nullopt;
    return Polynomial{c};
  }
  if (entry.key == "saturation") {
    if (const auto block = read_saturation(value)) return *block;
    return std::nullopt;
  }
  if (entry.key == "deadband") {
    if (const auto width = value.number(kNotNegative)) return Deadband{*width};
    return std::nullopt;
  }
  if (entry.key == "stuck") {
    if (const auto since = read_since(value, "value")) return Stuck{since->value, since->onset_s};
    return std::nullopt;
  }
  if (entry.key == "offset") {
    if (const auto since = read_since(value, "size"))
      return InputOffset{since->value, since->onset_s};
    return std::nullopt;
  }
  if (entry.key == "two_sided") {
    if (const auto sides = read_two_sided(value)) return *sides;
    return std::nullopt;
  }
  if (entry.key == "product") {
    if (const auto product = read_product(value, inputs, input)) return *product;
    return std::nullopt;
  }
  if (const auto block = read_stiction(value)) return *block;
  return std::nullopt;
}

std::optional<OutputBlock> read_output(const Map::Entry& entry) {
  const Value& value = entry.value;
  if (entry.key == "saturation") {
    if (const auto block = read_saturation(value)) return *block;
    return std::nullopt;
  }
  const std::optional<double> number = value.number();
  if (!number) return std::nullopt;
  if (entry.key == "offset") return Offset{*number};
  if (*number == 0.0) {
    value.error("must not be 0");
    return std::nullopt;
  }
  return Scale{*number};
}

/// The only entry of a block; null where there is none, or several (reported).
const Map::Entry* only_entry(const Map& block) {
  if (block.entries().size() > 1) block.place().error("takes one block only");
  return block.entries().size() == 1 ? &block.entries().front() : nullptr;
}

template <class Block, class Read>
void read_by_tag(const Value& section, const std::vector<std::string>& tags, Read read,
                 std::vector<std::optional<Block>>& blocks) {
  const Map by_tag = section.map(tags, "tag");
  for (const Map::Entry& entry : by_tag.entries()) {
    const auto index = std::find(tags.begin(), tags.end(), entry.key) - tags.begin();
    blocks[static_cast<std::size_t>(index)] = read(entry.value, static_cast<int>(index));
  }
}

}  // namespace

std::optional<InputBlock> read_input_block(const Value& value,
                                           const std::vector<std::string>& inputs, int input) {
  const Map block = value.map({"polynomial", "saturation", "deadband", "stiction", "stuck",
                               "offset", "two_sided", "product"});
  const Map::Entry* only = only_entry(block);
  if (only == nullptr) return std::nullopt;
  return read_input(*only, inputs, input);
}

std::optional<OutputBlock> read_output_block(const Value& value) {
  const Map block = value.map({"saturation", "offset", "scale"});
  const Map::Entry* only = only_entry(block);
  if (only == nullptr) return std::nullopt;
  return read_output(*only);
}

void read_input_blocks(const Value& section, const std::vector<std::string>& tags,
                       std::vector<std::optional<InputBlock>>& blocks) {
  read_by_tag(
      section, tags,
      [&tags](const Value& value, int input) { return read_input_block(value, tags, input); },
      blocks);
}

void read_output_blocks(const Value& section, const std::vector<std::string>& tags,
                        std::vector<std::optional<OutputBlock>>& blocks) {
  read_by_tag(
      section, tags, [](const Value& value, int) { return read_output_block(value); }, blocks);
}

}  // namespace mpm::config
