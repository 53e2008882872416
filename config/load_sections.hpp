#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/choice.hpp"
#include "config/fields.hpp"
#include "config/load_unit.hpp"
#include "config/suggest.hpp"
#include "config/unit_config.hpp"
#include "config/yaml_value.hpp"

/// Readers of the unit file's sections. Private to this room. Each takes null where the section is
/// missing, then fills in defaults of the right length.
namespace mpm::config {

inline constexpr std::size_t kLongestTag = 128;

void load_signals(const Value* section, UnitConfig& config);
/// After all other signals: what is calculated from them.
void load_calculated(const Map& signals, UnitConfig& config);
void load_model(const Value& root, const Value* section, const Value* top_level_origin,
                ModelNeed need, UnitConfig& config);
/// Overwrites in `monitor` what the section gives.
void load_monitor(const Value* section, const UnitConfig& unit, MonitorSettings& monitor);
void load_alarms(const Value* section, UnitConfig& config);
void load_dds(const Value* section, UnitConfig& config);
void load_simulation(const Value* section, UnitConfig& config);
void load_identify(const Value* section, UnitConfig& config);

/// A part of `load_model`; see load_model_parts.hpp for the others.
/// `map` has A, B, C and perhaps D and x0.
void load_state_space(const Map& map, UnitConfig& config);

/// `low` and `high` of a map, either or both; reported where low is not below high.
template <class Limits>
void read_low_high(const Map& map, Limits& limits) {
  const auto read = [&map](std::string_view key) {
    const Value* value = map.find(key);
    return value != nullptr ? value->number(kAny) : std::nullopt;
  };
  limits.low = read("low");
  limits.high = read("high");
  if (limits.low && limits.high && *limits.low >= *limits.high)
    map.find("high")->error("must be above low");
}

/// Index of the tag that `value` names, or -1 (reported as an unknown `noun`).
[[nodiscard]] int find_tag(const Value& value, const std::vector<std::string>& tags,
                           std::string_view noun);

/// The kind that `value` names; `otherwise` (reported) where it names none.
template <class Kind>
[[nodiscard]] Kind read_choice(const Value& value, Kind otherwise) {
  const std::optional<std::string> name = value.text();
  if (!name) return otherwise;
  std::vector<std::string> names;
  for (const Choice<Kind>& choice : choices(otherwise)) {
    if (*name == choice.name) return choice.kind;
    names.emplace_back(choice.name);
  }
  value.error("must be one of " + join(names) + ", not '" + *name + "'");
  return otherwise;
}

/// Fills `settings` from the keys of `map` that `fields` describes.
template <class Settings>
void read_fields(const Map& map, const std::vector<Field<Settings>>& fields, Settings& settings) {
  for (const Field<Settings>& field : fields) {
    const Value* value = map.find(field.key);
    if (value == nullptr) continue;
    const auto read = [&](auto member) {
      auto& target = settings.*member;
      using Type = std::remove_reference_t<decltype(target)>;
      if constexpr (std::is_same_v<Type, double>) {
        target = value->number(field.range).value_or(target);
      } else if constexpr (std::is_same_v<Type, int>) {
        target = value->integer(field.range).value_or(target);
      } else if constexpr (std::is_same_v<Type, bool>) {
        target = value->boolean().value_or(target);
      } else if constexpr (std::is_enum_v<Type>) {
        target = read_choice(*value, target);
      } else {
        target = value->free_text().value_or(target);
      }
    };
    std::visit(read, field.member);
  }
}

}  // namespace mpm::config
