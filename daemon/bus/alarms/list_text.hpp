#pragma once

#include <string>

#include "daemon/bus/alarms/alarm_list.hpp"
#include "daemon/report/terminal/terminal_text.hpp"

namespace mpm::bus {

/// The alarms of `unit`, or of all where it is empty: per unit the controller's, then those of its
/// channels that are not normal; with `all` those too.
[[nodiscard]] std::string alarm_list_text(const AlarmList& list, const std::string& unit, bool all,
                                          const report::Layout& layout);

}  // namespace mpm::bus
