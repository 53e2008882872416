#pragma once

#include "daemon/report/health.hpp"
#include "daemon/report/records.hpp"
#include "mpm.h"

namespace mpm::bus {

/// The way back from what OutputWriters wrote.
[[nodiscard]] report::ChannelRecord record_of(const mpm_ChannelStatus& sample);
[[nodiscard]] report::AlarmRecord record_of(const mpm_Alarm& sample);
[[nodiscard]] report::AlarmRecord record_of(const mpm_AlarmEvent& sample);
[[nodiscard]] report::HealthRecord record_of(const mpm_Health& sample);

}  // namespace mpm::bus
