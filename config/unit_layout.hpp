#pragma once

#include "config/unit_config.hpp"
#include "core/signal/unit_layout.hpp"

namespace mpm::config {

/// What a control system publishes of this unit: kinds of which no CV has a signal are not there.
[[nodiscard]] UnitLayout unit_layout(const UnitConfig& unit);

}  // namespace mpm::config
