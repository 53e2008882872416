#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/live/diagnosis_schedule.hpp"
#include "daemon/live/diagnosis_worker.hpp"
#include "daemon/live/frame_ring.hpp"

namespace mpm {
class Archive;
}

namespace mpm::live {

/// The diagnoses of one unit: keeps its last samples, has them diagnosed while an alarm stands, and
/// adds to the alarms what comes of it.
class LiveDiagnosis {
 public:
  using Clock = std::chrono::steady_clock;

  /// `asker`: of all units that share `worker`, this one.
  LiveDiagnosis(std::shared_ptr<const config::UnitConfig> unit, DiagnosisWorker& worker, int asker);

  /// After a frame was judged, and its outputs written: with the alarms that it changed.
  void push(const Frame& frame, const std::vector<AlarmRecord>& changes);
  /// Now and then: starts what could not be started, has written each minute what could not be
  /// written, and hands over what has been found.
  [[nodiscard]] std::optional<DiagnosisOutcome> poll(Clock::time_point now);
  /// The samples, and when they were diagnosed; then `resume`, with the unit's alarms.
  void archive(Archive& a);
  void resume(const std::vector<AlarmStateRecord>& alarms);
  /// Makes again what a process before this one has found or was at, if an alarm still stands.
  void repeat();
  /// Why reports cannot be kept; empty: they can, as far as is known.
  void set_file_problem(std::string problem) { file_problem_ = std::move(problem); }
  [[nodiscard]] const std::string& file_problem() const { return file_problem_; }
  /// The alarms that stand, with what `outcome` says of them; none that it could not know of.
  [[nodiscard]] std::vector<AlarmRecord> diagnosed(const DiagnosisOutcome& outcome) const;

 private:
  struct Standing {
    AlarmRecord alarm;
    std::size_t channel = 0;  // inputs outermost
  };

  void note(const AlarmRecord& change);
  void ask();
  void write_again(Clock::time_point now);

  std::shared_ptr<const config::UnitConfig> unit_;
  DiagnosisWorker& worker_;
  int asker_;
  FrameRing ring_;
  DiagnosisSchedule schedule_;
  std::map<std::pair<std::string, std::string>, Standing> alarms_;  // by (input, CV)
  std::int64_t youngest_alarm_ns_ = 0;
  std::optional<DiagnosisJob> pending_;  // the worker had no time to take it
  std::string file_problem_;
  std::shared_ptr<const report::DiagnosisRun> unwritten_;  // the last report, where it is
  std::int64_t unwritten_alarm_ns_ = 0;
  Clock::time_point next_try_{};
};

}  // namespace mpm::live
