#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "daemon/files/times/time_style.hpp"

namespace mpm::app {

/// `--time-zone` of a command that only reads.
void add_time_zone(CLI::App& command, std::string& name);

/// `--time-format`, of every command that reads a CSV.
void add_time_format(CLI::App& command, std::string& format);

/// Both of them, with as long a life as the command line.
struct TimesText {
  std::string zone, format;
};
void add_times(CLI::App& command, TimesText& text);
/// Throws config::InputError where there is no such zone, or the format is none.
[[nodiscard]] files::TimeStyle times_of(const TimesText& text);

/// What such an option names; null for nothing and `seconds`, where local times are refused. Throws
/// config::InputError where there is no such zone.
[[nodiscard]] std::shared_ptr<const files::TimeZone> zone_of(const std::string& name);

}  // namespace mpm::app
