#pragma once

#include <cstdint>
#include <string>

#include "daemon/report/diagnosis/diagnosis_run.hpp"

namespace mpm::live {

/// The reports of the daemon's diagnoses: STATE/UNIT/20240501T120000Z/report.html and so on. A
/// later diagnosis of the same alarm takes the place of the earlier one.
class ReportStore {
 public:
  static constexpr std::size_t kKept = 20;

  /// `folder` empty: nothing is kept.
  explicit ReportStore(std::string folder, std::size_t kept = kKept);

  /// Why nothing can be written there, as of now; empty if it can, or nothing is kept.
  [[nodiscard]] std::string problem() const;
  /// Returns where the report lies; empty if nothing is kept. Throws std::exception where it cannot
  /// be written.
  [[nodiscard]] std::string write(const report::DiagnosisRun& run,
                                  std::int64_t alarm_time_ns) const;

 private:
  std::string folder_;
  std::size_t kept_;  // of each unit, the last ones written
};

}  // namespace mpm::live
