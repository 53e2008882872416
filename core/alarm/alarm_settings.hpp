#pragma once

#include <array>
#include <string>

#include "core/alarm/calibration.hpp"
#include "core/alarm/managed_alarm.hpp"
#include "core/text/words.hpp"

namespace mpm {

/// Whom it is for: an alarm needs an operator's answer in time, an alert an engineer's, sooner or
/// later, an event nobody's (ISA-18.2, TR18.2.8).
enum class NotificationClass : unsigned char { kEvent, kAlert, kAlarm };
[[nodiscard]] constexpr auto words_of(NotificationClass) {
  return std::array{"event", "alert", "alarm"};
}

enum class AlarmPriority : unsigned char { kLow, kMedium, kHigh };
[[nodiscard]] constexpr auto words_of(AlarmPriority) { return std::array{"low", "medium", "high"}; }

/// Of OPC UA, 1..1000.
[[nodiscard]] constexpr int severity(AlarmPriority priority) {
  return calibration::kSeverities[static_cast<std::size_t>(priority)];
}

/// The one alarm of a controller: its model is not to be trusted. Those of its channels are alerts.
struct ControllerAlarmSettings {
  NotificationClass notification_class = NotificationClass::kAlert;
  AlarmPriority priority = AlarmPriority::kLow;
  double on_delay_s = 0.0;
  /// A shift: what comes and goes within it is one alarm.
  double off_delay_s = calibration::kControllerOffDelay;
  /// What an alarm must say: what happens if nobody acts, what to do, and how soon.
  std::string consequence, action;
  double time_to_respond_s = 0.0;
  std::string guidance, display_url, runbook;
};

/// What becomes of the alarms of a unit once they are raised.
struct AlarmHandling {
  ManagedAlarm::Settings managed;
  ControllerAlarmSettings controller;
};

}  // namespace mpm
