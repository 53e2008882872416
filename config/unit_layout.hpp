#pragma once

#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/signal/unit_layout.hpp"

namespace mpm::config {

/// Tags of one kind of signal, in the unit file's order; "" for a CV that has no such signal.
[[nodiscard]] std::vector<std::string> tags_of(const UnitConfig& unit, SignalKind kind);
/// Their engineering units; "" where none is given.
[[nodiscard]] std::vector<std::string> engineering_units_of(const UnitConfig& unit,
                                                            SignalKind kind);

/// What a control system publishes of this unit: kinds of which no CV has a signal are not there.
[[nodiscard]] UnitLayout unit_layout(const UnitConfig& unit);

}  // namespace mpm::config
