#pragma once

#include <cstdint>
#include <string>

#include "core/alarm/alarm_settings.hpp"
#include "core/alarm/managed_alarm.hpp"
#include "core/record/field_key.hpp"

namespace mpm {

/// What a control room knows of any alarm, under the names of OPC 10000-9 where it has one; part of
/// AlarmStateRecord and ControllerAlarmRecord.
struct ControlRoomView {
  AlarmWord alarm_state = AlarmWord::kNormal;
  bool acknowledged = true;
  Shelving shelving_state = Shelving::kUnshelved;
  std::int64_t unshelve_time_ns = 0;  ///< UTC
  bool suppressed = false;
  bool suppressed_by_design = false;
  bool out_of_service = false;
  bool retain = false;              ///< a list of what is of interest shows it
  std::int64_t active_time_ns = 0;  ///< of the plant's data
  std::int64_t ack_time_ns = 0;     ///< UTC
  std::string client_user_id, comment;
  NotificationClass notification_class = NotificationClass::kAlert;
  AlarmPriority priority = AlarmPriority::kLow;
  int severity = 0;  ///< 1..1000
  std::string message;

  ControlRoomView() = default;
  ControlRoomView(const AlarmStanding& standing, NotificationClass notification,
                  AlarmPriority how_urgent)
      : alarm_state(standing.word()),
        acknowledged(standing.annunciation == Annunciation::kNormal ||
                     standing.annunciation == Annunciation::kAcknowledged),
        shelving_state(standing.shelving),
        unshelve_time_ns(standing.unshelve_time_ns),
        suppressed(standing.suppressed),
        suppressed_by_design(standing.suppressed_by_design),
        out_of_service(standing.out_of_service),
        retain(standing.listed()),
        active_time_ns(standing.active_time_ns),
        ack_time_ns(standing.ack_time_ns),
        client_user_id(standing.user),
        comment(standing.comment),
        notification_class(notification),
        priority(how_urgent),
        severity(mpm::severity(how_urgent)) {}

  /// See FieldKey.
  template <class Visit, class Record, class... Sample>
  static void fields(Visit&& visit, Record& record, Sample&... sample) {
    visit("alarm_state", record.alarm_state, sample.alarm_state...);
    visit("acknowledged", record.acknowledged, sample.acknowledged...);
    visit("shelving_state", record.shelving_state, sample.shelving_state...);
    visit("unshelve_time_ns", record.unshelve_time_ns, sample.unshelve_time_ns...);
    visit("suppressed", record.suppressed, sample.suppressed...);
    visit("suppressed_by_design", record.suppressed_by_design, sample.suppressed_by_design...);
    visit("out_of_service", record.out_of_service, sample.out_of_service...);
    visit("retain", record.retain, sample.retain...);
    visit("active_time_ns", record.active_time_ns, sample.active_time_ns...);
    visit("ack_time_ns", record.ack_time_ns, sample.ack_time_ns...);
    visit("client_user_id", record.client_user_id, sample.client_user_id...);
    visit("comment", record.comment, sample.comment...);
    visit("notification_class", record.notification_class, sample.notification_class...);
    visit("priority", record.priority, sample.priority...);
    visit("severity", record.severity, sample.severity...);
    visit("message", record.message, sample.message...);
  }
};

}  // namespace mpm
