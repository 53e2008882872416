#pragma once

#include <memory>
#include <string>

#include "daemon/files/times/time_format.hpp"
#include "daemon/files/times/time_zone.hpp"

namespace mpm::files {

/// What the user says about the times of a file.
struct TimeStyle {
  std::shared_ptr<const TimeZone> zone;      ///< of local times; null = they are refused
  std::shared_ptr<const TimeFormat> format;  ///< of all times; null = found
  std::string zone_said = {};  ///< behind the zone where it is told: who said so, or another
};

}  // namespace mpm::files
