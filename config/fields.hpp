#pragma once

#include <string>
#include <variant>
#include <vector>

#include "config/range.hpp"
#include "config/unit_config.hpp"

/// The keys of the sections that are plain settings, once for reading and printing.
namespace mpm::config {

template <class Settings>
struct Field {
  const char* key;
  std::variant<double Settings::*, int Settings::*, bool Settings::*, std::string Settings::*,
               CorrelationKind Settings::*, ThresholdKind Settings::*, NonlinearTest Settings::*,
               NotificationClass Settings::*, AlarmPriority Settings::*>
      member;
  Range range;        ///< of numbers
  const char* notes;  ///< printed beside the value
};

[[nodiscard]] const std::vector<Field<MonitorSettings>>& monitor_fields();
[[nodiscard]] const std::vector<Field<MaterialitySettings>>& materiality_fields();
[[nodiscard]] const std::vector<Field<AlarmSettings>>& alarm_fields();
[[nodiscard]] const std::vector<Field<ManagedAlarm::Settings>>& managed_alarm_fields();
[[nodiscard]] const std::vector<Field<ControllerAlarmSettings>>& controller_alarm_fields();
[[nodiscard]] const std::vector<Field<DdsSettings>>& bus_fields();
[[nodiscard]] const std::vector<Field<SimulationSettings>>& simulation_fields();
[[nodiscard]] const std::vector<Field<NoiseSettings>>& noise_fields();
[[nodiscard]] const std::vector<Field<SetpointSettings>>& setpoint_fields();

template <class Settings>
[[nodiscard]] std::vector<std::string> keys(const std::vector<Field<Settings>>& fields) {
  std::vector<std::string> names;
  names.reserve(fields.size());
  for (const Field<Settings>& field : fields) names.emplace_back(field.key);
  return names;
}

}  // namespace mpm::config
