#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/record/alarm_record.hpp"
#include "daemon/live/frame_ring.hpp"
#include "daemon/report/diagnosis/diagnosis_run.hpp"

namespace mpm::live {

/// One diagnosis to be made, or only a report of one to be written after all; holds copies only, so
/// that it may outlive who asked.
struct DiagnosisJob {
  int asker = 0;  ///< who gets the outcome
  bool only_writes = false;
  std::shared_ptr<const report::DiagnosisRun> unwritten;  ///< null: only see whether it could be
  std::shared_ptr<const config::UnitConfig> unit;
  RingCopy samples;
  int unseen_rows = 0;             ///< at the end, on which the gain is measured
  std::int64_t alarm_time_ns = 0;  ///< of the youngest alarm
};

/// What came of it, in words: the thread that made it neither logs nor publishes, lest the monitor
/// ever waits for a lock that a thread of low priority holds.
struct DiagnosisOutcome {
  int asker = 0;
  std::int64_t interval = 0;  ///< of the last sample diagnosed
  std::int64_t time_ns = 0;
  std::string headline;            ///< what was found; empty where there was no diagnosis
  std::string problem;             ///< why there was none
  std::vector<NamedCause> causes;  ///< of each channel; inputs outermost, CVs innermost
  std::string folder;              ///< where the report lies; may be empty
  std::string file_problem;        ///< why it does not
  bool only_wrote = false;         ///< of an earlier diagnosis, which has been told
  std::shared_ptr<const report::DiagnosisRun> unwritten;  ///< what could not be written
  std::int64_t alarm_time_ns = 0;                         ///< as in the job
};

}  // namespace mpm::live
