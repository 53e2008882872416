#pragma once

#include <iosfwd>

#include "config/unit_config.hpp"

namespace mpm::config {

/// The `model:` section. Private to this room.
void print_model(const UnitConfig& config, std::ostream& out);

}  // namespace mpm::config
