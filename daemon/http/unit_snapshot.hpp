#pragma once

#include <cstdint>
#include <vector>

#include "core/record/alarm_record.hpp"
#include "core/record/channel_record.hpp"
#include "core/record/controller_alarm_record.hpp"
#include "core/record/health_record.hpp"
#include "core/record/performance_record.hpp"
#include "daemon/bus/trouble.hpp"

namespace mpm::http {

/// A copy of a unit as it stood; never changed once it is there, so that any thread may read it.
struct UnitSnapshot {
  std::uint64_t id = 0;  ///< counts up; 0 before the first
  std::vector<ChannelRecord> channels;
  std::vector<AlarmStateRecord> alarms;  ///< of each channel
  ControllerAlarmRecord controller;
  HealthRecord health;
  std::vector<bus::Trouble> troubles;
  PerformanceRecord performance;
  bool speaks = true;  ///< no other monitor does for this unit
};

}  // namespace mpm::http
