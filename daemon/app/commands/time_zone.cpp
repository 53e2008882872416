#include "daemon/app/commands/time_zone.hpp"

namespace mpm::app {

void add_time_zone(CLI::App& command, std::string& name) {
  command.add_option("--time-zone", name,
                     "zone of local times in a CSV, such as Europe/Berlin or UTC (default: they "
                     "are refused)");
}

std::shared_ptr<const files::TimeZone> zone_of(const std::string& name) {
  if (name.empty() || name == "seconds") return nullptr;
  return std::make_shared<files::TimeZone>(name == "utc" ? "UTC" : name);
}

void add_time_format(CLI::App& command, std::string& format) {
  const auto says_something = [](const std::string& text) {
    return text.find_first_not_of(' ') == std::string::npos
               ? "is empty: leave it out, or say how the times are written"
               : "";
  };
  command
      .add_option("--time-format", format,
                  "how the times of a CSV are written, in letters of strftime such as "
                  "'%d/%m/%Y %H:%M:%S', where they are not understood")
      ->check(says_something);
}

void add_times(CLI::App& command, TimesText& text) {
  add_time_zone(command, text.zone);
  add_time_format(command, text.format);
}

files::TimeStyle times_of(const TimesText& text) {
  return {zone_of(text.zone),
          text.format.empty() ? nullptr : std::make_shared<files::TimeFormat>(text.format)};
}

}  // namespace mpm::app
