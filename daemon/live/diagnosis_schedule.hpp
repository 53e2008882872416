#pragma once

#include <cstdint>
#include <optional>

namespace mpm {
class Archive;
}

namespace mpm::live {

struct ScheduleSettings {
  int needed_rows = 0;         ///< fewer are no diagnosis
  int settling_rows = 300;     ///< after an alarm began, so that there is something to see of it
  int renewed_rows = 3000;     ///< so many new ones are reason for another diagnosis
  std::int64_t period_ns = 0;  ///< of source time, between two diagnoses at least
};

/// Says when a unit is to be diagnosed: once an alarm has settled, again whenever the samples since
/// it began have doubled or enough of the ring is new, and no more often than the period allows.
/// Counts samples and source time only, so that the same data give the same diagnoses.
class DiagnosisSchedule {
 public:
  explicit DiagnosisSchedule(const ScheduleSettings& settings) : settings_(settings) {}

  /// To be called after each frame. `raised`: this one brought a new alarm; `active`: some alarm
  /// stands; `rows`: in the ring. True: now.
  [[nodiscard]] bool due(std::int64_t time_ns, int rows, bool raised, bool active);

  /// Whether a diagnosis was due before.
  [[nodiscard]] bool started() const { return last_start_ns_.has_value(); }
  /// Frames since the youngest alarm began.
  [[nodiscard]] std::int64_t rows_since_alarm() const { return since_alarm_; }

  void archive(Archive& a);

 private:
  ScheduleSettings settings_;
  bool waiting_ = false;
  std::int64_t since_alarm_ = 0;
  std::int64_t next_at_ = 0;  // in frames since the alarm
  std::optional<std::int64_t> last_start_ns_;
};

/// Rows at the end of the ring that are left to measure the gain on: half of what came after the
/// alarm, because the fit has to see the change as well, but never more than the usual third.
[[nodiscard]] int unseen_rows(int rows, std::int64_t rows_since_alarm);

}  // namespace mpm::live
