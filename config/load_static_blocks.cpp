#include <algorithm>

#include "config/load_sections.hpp"
#include "config/yaml_text.hpp"

namespace mpm::config {
namespace {

std::optional<Saturation> read_saturation(const Value& value) {
  const std::vector<double> limits = value.numbers();
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
  const Map map = value.map({"band", "jump"});
  const Value* band = map.require("band");
  const Value* jump = map.require("jump");
  const auto width = band != nullptr ? band->number(kNotNegative) : std::nullopt;
  const auto slip = jump != nullptr ? jump->number(kNotNegative) : std::nullopt;
  if (!width || !slip) return std::nullopt;
  return Stiction{*width, *slip};
}

std::optional<InputBlock> read_input_block(const Map::Entry& entry) {
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
  if (const auto block = read_stiction(value)) return *block;
  return std::nullopt;
}

std::optional<OutputBlock> read_output_block(const Map::Entry& entry) {
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

template <class Block, class Read>
void read_blocks(const Map& model, std::string_view key, const std::vector<std::string>& tags,
                 const std::vector<std::string>& kinds, Read read,
                 std::vector<std::optional<Block>>& blocks) {
  const Value* section = model.find(key);
  if (section == nullptr) return;
  const Map by_tag = section->map(tags, "tag");
  for (const Map::Entry& entry : by_tag.entries()) {
    const Map block = entry.value.map(kinds);
    if (block.entries().size() != 1) {
      if (block.entries().size() > 1) entry.value.error("takes one block only");
      continue;
    }
    const auto index = std::find(tags.begin(), tags.end(), entry.key) - tags.begin();
    blocks[static_cast<std::size_t>(index)] = read(block.entries().front());
  }
}

}  // namespace

void load_static_blocks(const Map& model, UnitConfig& config) {
  read_blocks(model, "input", config.input_tags(),
              {"polynomial", "saturation", "deadband", "stiction"}, read_input_block,
              config.model.input_blocks);
  read_blocks(model, "output", config.cv_tags(), {"saturation", "offset", "scale"},
              read_output_block, config.model.output_blocks);
}

}  // namespace mpm::config
