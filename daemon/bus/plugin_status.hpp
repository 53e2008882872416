#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mpm::bus {

/// What a unit's monitor said last.
struct MonitorWord {
  std::string unit;
  std::string state, detail;  ///< of mpm/health; empty: nothing came
  std::uint32_t active_alarms = 0;
  double age_s = 0.0;                 ///< since it was written
  bool gone = false;                  ///< the monitor has left since
  std::string place = {};             ///< where it was looked for; may be empty
  std::uint32_t silenced_alarms = 0;  ///< of the active ones
};

/// Ages of a unit's last health from which on it is a warning, or critical.
struct AgeLimits {
  double warning_s = 5.0;
  double critical_s = 30.0;
};

/// What a monitoring plug-in says: code 0 OK, 1 WARNING, 2 CRITICAL, 3 UNKNOWN, and one line with
/// performance data after '|'.
struct PluginStatus {
  int code = 0;
  std::string line;
};

/// Of several units the worst. A unit that said nothing is critical, as is no unit at all.
[[nodiscard]] PluginStatus plugin_status(const std::vector<MonitorWord>& units,
                                         const AgeLimits& limits, const std::string& place);

}  // namespace mpm::bus
