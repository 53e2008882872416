#pragma once

#include "daemon/bus/health.hpp"
#include "daemon/report/records.hpp"
#include "mpm.h"

namespace mpm::daemon {

/// The way back from what OutputWriters wrote.
[[nodiscard]] ChannelRecord record_of(const mpm_ChannelStatus& sample);
[[nodiscard]] AlarmRecord record_of(const mpm_Alarm& sample);
[[nodiscard]] AlarmRecord record_of(const mpm_AlarmEvent& sample);
[[nodiscard]] HealthRecord record_of(const mpm_Health& sample);

}  // namespace mpm::daemon
