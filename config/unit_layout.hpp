#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "config/unit_config.hpp"
#include "core/signal/unit_layout.hpp"

namespace mpm::config {

/// Tags of one kind of signal, in the unit file's order; "" for a CV that has no such signal.
[[nodiscard]] std::vector<std::string> tags_of(const UnitConfig& unit, SignalKind kind);
/// The same, with "" for what is calculated: what has to come from somewhere.
[[nodiscard]] std::vector<std::string> measured_tags_of(const UnitConfig& unit, SignalKind kind);
/// Counts per kind and signal (empty where a kind has none), by tag; without those that are 0.
using SignalTally = std::array<std::vector<std::uint64_t>, kSignalKindCount>;
[[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> by_tag(const UnitConfig& unit,
                                                                        const SignalTally& counts);
/// Whether values that are called so are this unit's of that kind; a calculated one may be called
/// "" as well.
[[nodiscard]] bool is_layout_of(const UnitConfig& unit, SignalKind kind,
                                const std::vector<std::string>& tags);
/// Their engineering units; "" where none is given.
[[nodiscard]] std::vector<std::string> engineering_units_of(const UnitConfig& unit,
                                                            SignalKind kind);

/// What a control system publishes of this unit: kinds of which no CV has a signal, or
/// none that is measured, are not there. A calculated signal keeps its place, with tag "".
[[nodiscard]] UnitLayout unit_layout(const UnitConfig& unit);

}  // namespace mpm::config
