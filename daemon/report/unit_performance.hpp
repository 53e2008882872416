#pragma once

#include <nlohmann/json.hpp>
#include <span>

#include "config/unit_config.hpp"
#include "core/monitor/cv_reading.hpp"
#include "core/performance/performance_meter.hpp"
#include "core/performance/plausible_frames.hpp"
#include "core/record/performance_record.hpp"

namespace mpm::report {

/// What a unit's indices of control performance are told by. Without a model the horizons of its
/// predictions are one sample and two.
[[nodiscard]] PerformanceSetup performance_setup(const config::UnitConfig& unit);

/// The indices with tags, all that is not of the samples alone: interval, time and window are 0.
/// `setup`: what `sums` were made with.
[[nodiscard]] PerformanceRecord performance_record(const config::UnitConfig& unit,
                                                   const PerformanceSetup& setup,
                                                   const PerformanceSums& sums);

/// The object of `mpm detect --json` and report.json: without what is of a window.
[[nodiscard]] nlohmann::ordered_json performance_json(const PerformanceRecord& record);

/// The indices over all frames of a unit.
class PerformanceTally {
 public:
  explicit PerformanceTally(const config::UnitConfig& unit);

  /// A frame, and what came to be read of it and of those before (`Monitor::judged`).
  void push(const Frame& frame, std::span<const JudgedFrame> judged);
  /// What follows is another run.
  void begin_run();
  [[nodiscard]] PerformanceRecord record() const;

 private:
  void take();

  config::UnitConfig unit_;
  PlausibleFrames frames_;
  PerformanceMeter meter_;
  PerformanceSums sums_;
};

}  // namespace mpm::report
