#pragma once

#include <string>
#include <vector>

#include "config/unit_config.hpp"

namespace mpm::recording {

/// The tags of one kind in the order of its values; "" where a CV has no such signal.
[[nodiscard]] std::vector<std::string> tags_of(const config::UnitConfig& unit, SignalKind kind);
/// Their engineering units; "" where none is given.
[[nodiscard]] std::vector<std::string> engineering_units_of(const config::UnitConfig& unit,
                                                            SignalKind kind);
/// "mv" ... "aux".
[[nodiscard]] const char* name_of(SignalKind kind);

}  // namespace mpm::recording
