#include "daemon/app/commands/time_zone.hpp"

namespace mpm::app {

void add_time_zone(CLI::App& command, std::string& name) {
  command.add_option("--time-zone", name,
                     "zone of local times in a CSV, such as Europe/Berlin (default: they are "
                     "refused)");
}

std::shared_ptr<const files::TimeZone> zone_of(const std::string& name) {
  if (name.empty() || name == "utc" || name == "UTC" || name == "seconds") return nullptr;
  return std::make_shared<files::TimeZone>(name);
}

}  // namespace mpm::app
