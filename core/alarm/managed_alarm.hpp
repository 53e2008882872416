#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/alarm/alarm_command.hpp"
#include "core/alarm/annunciation.hpp"
#include "core/alarm/calibration.hpp"
#include "core/text/words.hpp"

namespace mpm {

/// As OPC 10000-9, ShelvedStateMachineType.
enum class Shelving : unsigned char { kUnshelved, kOneShot, kTimed };
[[nodiscard]] constexpr auto words_of(Shelving) {
  return std::array{"unshelved", "one_shot_shelved", "timed_shelved"};
}

/// The one word that a list shows: where an alarm is silenced, by whom comes first.
enum class AlarmWord : unsigned char {
  kNormal,
  kUnacknowledged,
  kAcknowledged,
  kReturned,
  kShelved,
  kSuppressed,
  kOutOfService,
};
[[nodiscard]] constexpr auto words_of(AlarmWord) {
  return std::array{"normal",  "unacknowledged", "acknowledged",  "returned_unacknowledged",
                    "shelved", "suppressed",     "out_of_service"};
}

/// How an alarm stands. Three ways of silence are kept apart: by an operator for a time (shelved),
/// by what the plant is doing (suppressed), by maintenance (out of service).
struct AlarmStanding {
  Annunciation annunciation = Annunciation::kNormal;
  Shelving shelving = Shelving::kUnshelved;
  std::int64_t unshelve_time_ns = 0;  ///< UTC; 0 unless shelved
  bool suppressed = false;            ///< by command
  bool suppressed_by_design = false;  ///< its question has no meaning now
  bool out_of_service = false;
  std::int64_t active_time_ns = 0;  ///< of the plant's data, since when; 0: never was
  std::int64_t ack_time_ns = 0;     ///< UTC, of the last acknowledgement; 0: none
  std::string user, comment;        ///< of the last command

  [[nodiscard]] bool is_suppressed() const { return suppressed || suppressed_by_design; }
  [[nodiscard]] bool silenced() const {
    return shelving != Shelving::kUnshelved || is_suppressed() || out_of_service;
  }
  [[nodiscard]] bool silenced_by_design_alone() const {
    return suppressed_by_design && !suppressed && !out_of_service &&
           shelving == Shelving::kUnshelved;
  }
  [[nodiscard]] AlarmWord word() const;
  /// A list shows what stands, what nobody has seen yet and what people have silenced. Of what the
  /// plant alone silences that is there which would call else.
  [[nodiscard]] bool listed() const {
    return annunciation != Annunciation::kNormal || shelving != Shelving::kUnshelved ||
           suppressed || out_of_service;
  }
};

/// What became of an alarm.
enum class AlarmOccurrence : unsigned char {
  kActive,
  kCleared,
  kAcknowledged,
  kShelved,
  kUnshelved,
  kSuppressed,
  kUnsuppressed,
  kOutOfService,
  kInService,
  kReannounced,
};
[[nodiscard]] constexpr auto words_of(AlarmOccurrence) {
  return std::array{"active",     "cleared",      "acknowledged",   "shelved",    "unshelved",
                    "suppressed", "unsuppressed", "out_of_service", "in_service", "reannounced"};
}

/// Two clocks: the plant's data tell when something rose, people mean the wall's.
struct AlarmMoment {
  std::int64_t source_ns = 0;  ///< of the sample
  std::int64_t wall_ns = 0;    ///< UTC
};

/// One alarm with what people have done to it. While it is silenced it goes on following its cause,
/// and nobody need see what came and went meanwhile; if its cause is still there when the silence
/// ends, it is unacknowledged anew, unless somebody had seen it before.
class ManagedAlarm {
 public:
  struct Settings {
    bool latching = true;    ///< one that has gone waits until somebody has seen it
    double realarm_s = 0.0;  ///< unacknowledged anew after; 0 = never
    double max_shelve_s = calibration::kLongestShelf;
  };
  using Occurrences = std::vector<AlarmOccurrence>;  ///< appended to

  /// Whether its cause is there now, and whether the question has a meaning.
  void observe(bool active, bool meaningful, const AlarmMoment& now, const Settings& settings,
               Occurrences& occurred);
  /// What time alone brings.
  void tick(const AlarmMoment& now, const Settings& settings, Occurrences& occurred);
  CommandReply apply(const AlarmCommand& command, const AlarmMoment& now, const Settings& settings,
                     Occurrences& occurred);

  [[nodiscard]] const AlarmStanding& standing() const { return standing_; }
  [[nodiscard]] bool active() const { return active_; }
  /// What rises with the next `observe` is what somebody has acknowledged before.
  void know() { seen_before_ = true; }
  /// What held before a restart: what people did holds still. Whether its cause is there is to be
  /// found anew; one that nobody had seen waits as if it had returned.
  void restore(const AlarmStanding& before, const Settings& settings);
  /// What held before a restart after which the cause is known as it was: all of it holds.
  void resume(const AlarmStanding& before);

 private:
  CommandReply shelve(const AlarmCommand& command, const AlarmMoment& now, const Settings& settings,
                      Occurrences& occurred);
  void unshelve(Occurrences& occurred);

  AlarmStanding standing_;
  bool active_ = false;
  bool seen_before_ = false;  // what stands now or rises next, by somebody
};

}  // namespace mpm
