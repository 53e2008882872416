#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/alarm/managed_alarm.hpp"
#include "core/record/alarm_record.hpp"
#include "core/record/controller_alarm_record.hpp"

namespace mpm::live {

/// What readers of one unit's alarms know of them from another monitor that spoke: its last words.
struct ToldAlarms {
  using Channel = std::pair<std::string, std::string>;  ///< mv, cv

  std::map<Channel, AlarmStateRecord> states;
  std::map<Channel, AlarmRecord> events;
  std::optional<ControllerAlarmRecord> controller;

  /// Null: nothing was told.
  [[nodiscard]] const AlarmStateRecord* state(const std::string& mv, const std::string& cv) const {
    const auto it = states.find({mv, cv});
    return it == states.end() ? nullptr : &it->second;
  }
  /// Whether its alarm stands for who reads; nothing where nothing was told. An event comes before
  /// the state that it leads to, which may be missing; a monitor that has only taken over has told
  /// no event.
  [[nodiscard]] std::optional<bool> active(const std::string& mv, const std::string& cv) const {
    const auto event = events.find({mv, cv});
    const AlarmStateRecord* last = state(mv, cv);
    if (event != events.end() && (last == nullptr || event->second.interval > last->interval))
      return event->second.to != AlarmChange::kCleared;
    if (last == nullptr) return std::nullopt;
    return last->to == AlarmChange::kActive;
  }
};

/// What people and time had made of an alarm, as its view tells.
[[nodiscard]] inline AlarmStanding standing_of(const ControlRoomView& view, bool active) {
  AlarmStanding standing;
  standing.annunciation =
      active ? (view.acknowledged ? Annunciation::kAcknowledged : Annunciation::kUnacknowledged)
             : (view.acknowledged ? Annunciation::kNormal : Annunciation::kReturned);
  standing.shelving = view.shelving_state;
  standing.unshelve_time_ns = view.unshelve_time_ns;
  standing.suppressed = view.suppressed;
  standing.suppressed_by_design = view.suppressed_by_design;
  standing.out_of_service = view.out_of_service;
  standing.active_time_ns = view.active_time_ns;
  standing.ack_time_ns = view.ack_time_ns;
  standing.user = view.client_user_id;
  standing.comment = view.comment;
  return standing;
}

}  // namespace mpm::live
