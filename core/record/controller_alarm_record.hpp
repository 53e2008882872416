#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/alarm/condition.hpp"
#include "core/record/control_room_view.hpp"
#include "core/record/field_key.hpp"

namespace mpm {

/// The one alarm of a controller, for its operator; topic mpm/controller_alarm.
struct ControllerAlarmRecord {
  std::string unit;
  std::int64_t interval = 0;
  std::int64_t source_time_ns = 0;
  AlarmState state = AlarmState::kCleared;
  ControlRoomView view;
  int channels = 0;  ///< whose alarms stand, and which nobody has silenced
  /// As in the unit file.
  std::string consequence, action;
  double time_to_respond_s = 0.0;
  std::string guidance, display_url, runbook;

  /// See FieldKey.
  template <class Visit, class Record, class... Sample>
  static void fields(Visit&& visit, Record& record, Sample&... sample) {
    visit("record", std::string_view("controller_alarm"));
    visit("unit", record.unit, sample.unit...);
    visit("interval", record.interval, sample.interval...);
    visit("time_ns", record.source_time_ns, sample.source_time_ns...);
    visit("state", record.state, sample.state...);
    ControlRoomView::fields(visit, record.view, sample...);
    visit("channels", record.channels, sample.channels...);
    visit("consequence", record.consequence, sample.consequence...);
    visit("action", record.action, sample.action...);
    visit("time_to_respond", record.time_to_respond_s, sample.time_to_respond_s...);
    visit("guidance", record.guidance, sample.guidance...);
    visit("display_url", record.display_url, sample.display_url...);
    visit("runbook", record.runbook, sample.runbook...);
  }
};

}  // namespace mpm
