#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "daemon/files/times/time_zone.hpp"

namespace mpm::app {

/// `--time-zone` of a command that only reads.
void add_time_zone(CLI::App& command, std::string& name);

/// What such an option names; null for UTC (nothing, `utc`, `seconds`), where local times are
/// refused. Throws config::InputError where there is no such zone.
[[nodiscard]] std::shared_ptr<const files::TimeZone> zone_of(const std::string& name);

}  // namespace mpm::app
