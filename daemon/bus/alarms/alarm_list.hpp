#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "core/record/alarm_record.hpp"
#include "core/record/controller_alarm_record.hpp"
#include "idl/participant.hpp"

namespace mpm::bus {

/// How the alarms of a bus stand.
struct AlarmList {
  std::map<std::string, ControllerAlarmRecord> controllers;  // by unit
  std::map<std::tuple<std::string, std::string, std::string>, AlarmStateRecord> channels;  // unit..

  /// Those of `unit` alone, and of what is normal nothing; empty `unit`: of all.
  [[nodiscard]] std::vector<const AlarmStateRecord*> standing(const std::string& unit) const;
};

/// Listens until every unit was heard that a late joiner can hear, at least `settle` long after the
/// last word, or until `deadline`.
[[nodiscard]] AlarmList listen_to_alarms(const idl::Participant& participant,
                                         std::chrono::steady_clock::time_point deadline,
                                         const std::function<bool()>& stop);

}  // namespace mpm::bus
