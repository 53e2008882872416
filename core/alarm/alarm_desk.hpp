#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/alarm/alarm_settings.hpp"
#include "core/alarm/condition.hpp"
#include "core/alarm/managed_alarm.hpp"

namespace mpm {

/// The alarms of one unit as people meet them: one of each channel, and one of the controller,
/// which stands while that of any channel does that nobody has silenced. An operator gets the
/// controller's alone.
class AlarmDesk {
 public:
  static constexpr int kController = -1;
  static constexpr int kNone = -2;

  struct Channel {
    std::string mv, cv;  ///< tags
  };
  /// What a sample tells of a channel.
  struct Observation {
    bool active = false;
    bool meaningful = true;  ///< false while the controller is off or the data are bad
  };
  struct Occurrence {
    int alarm = kController;  ///< or the channel
    AlarmOccurrence what{};
    bool by_command = false;
  };

  AlarmDesk(const AlarmHandling& handling, double sample_time_s, std::vector<Channel> channels);

  /// After a sample, one for each channel.
  void observe(const std::vector<Observation>& channels, const AlarmMoment& now);
  /// What time alone brings; at any time.
  void tick(const AlarmMoment& now);
  /// The command's unit is this one.
  CommandReply apply(const AlarmCommand& command, const AlarmMoment& now);
  /// As ManagedAlarm::restore; false where there is no such alarm.
  bool restore(const std::string& mv, const std::string& cv, const AlarmStanding& before);
  /// As ManagedAlarm::resume; false where there is no such alarm.
  bool resume(const std::string& mv, const std::string& cv, const AlarmStanding& before);

  /// What the last `observe`, `tick` or `apply` brought about.
  [[nodiscard]] const std::vector<Occurrence>& occurred() const { return occurred_; }
  [[nodiscard]] const AlarmStanding& standing(int alarm) const { return of(alarm).standing(); }
  [[nodiscard]] bool active(int alarm) const { return of(alarm).active(); }
  /// Channels whose alarm stands, and which nobody has silenced.
  [[nodiscard]] int standing_channels() const;
  [[nodiscard]] int channels() const { return static_cast<int>(names_.size()); }
  [[nodiscard]] const Channel& channel(int index) const {
    return names_[static_cast<std::size_t>(index)];
  }
  /// kController where both are empty; kNone where there is no such channel.
  [[nodiscard]] int find(const std::string& mv, const std::string& cv) const;

 private:
  [[nodiscard]] const ManagedAlarm& of(int alarm) const {
    return alarm == kController ? controller_ : alarms_[static_cast<std::size_t>(alarm)];
  }
  [[nodiscard]] ManagedAlarm& of(int alarm) {
    return alarm == kController ? controller_ : alarms_[static_cast<std::size_t>(alarm)];
  }
  void note(int alarm, bool by_command);
  void settle(const AlarmMoment& now, bool new_sample);
  [[nodiscard]] bool all_seen() const;

  AlarmHandling handling_;
  Condition::Limits delays_;
  std::vector<Channel> names_;
  std::vector<ManagedAlarm> alarms_;
  std::vector<bool> seen_;      // acknowledged with the controller's, which silence has ended
  std::vector<int> senseless_;  // samples in a row, or back from them, as a count to a limit
  ManagedAlarm controller_;
  Condition trouble_;  // of the controller
  std::vector<AlarmOccurrence> fresh_;
  std::vector<Occurrence> occurred_;
};

}  // namespace mpm
