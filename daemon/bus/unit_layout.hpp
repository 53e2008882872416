#pragma once

#include "config/unit_config.hpp"
#include "idl/unit_publisher.hpp"

namespace mpm::daemon {

/// What the control system of `unit` publishes: every kind of signal of which it names a tag.
[[nodiscard]] idl::UnitLayout unit_layout(const config::UnitConfig& unit);

}  // namespace mpm::daemon
