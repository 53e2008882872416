#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/record/alarm_record.hpp"
#include "core/record/channel_record.hpp"
#include "core/record/controller_alarm_record.hpp"
#include "core/record/health_record.hpp"
#include "core/record/performance_record.hpp"
#include "daemon/bus/trouble.hpp"
#include "daemon/live/diagnosis_job.hpp"
#include "daemon/report/unit_monitor.hpp"

namespace mpm::live {

/// A unit as it stands.
struct UnitView {
  const std::vector<ChannelRecord>& channels;
  const std::vector<AlarmStateRecord>& alarms;
  const ControllerAlarmRecord& controller;
  const HealthRecord& health;
  const std::vector<bus::Trouble>& troubles;
  const PerformanceRecord& performance;  ///< over what there is of the window
  bool speaks = true;                    ///< no other monitor does
};

/// Looks on at one unit, from within the event loop: whatever it does, it does between two samples,
/// and quickly.
class UnitObserver {
 public:
  using Clock = std::chrono::steady_clock;

  UnitObserver() = default;
  UnitObserver(const UnitObserver&) = delete;
  UnitObserver& operator=(const UnitObserver&) = delete;
  virtual ~UnitObserver() = default;

  /// A frame was judged, and its outputs are written.
  virtual void on_frame(const Frame& frame, const report::UnitMonitor& monitor) = 0;
  /// Before all others: frames that a process before this one took, and what `monitor` makes of
  /// them; null where a state stands for that.
  virtual void on_recalled(const Frame& frame, const report::UnitMonitor* monitor) = 0;
  /// An alarm changed; `text`: what is wrong, in words, where it rose.
  virtual void on_alarm(const AlarmRecord& alarm, const std::string& text) = 0;
  virtual void on_diagnosis(const DiagnosisOutcome& outcome) = 0;
  /// Whether it wants to be shown the unit now.
  [[nodiscard]] virtual bool wants_view(Clock::time_point now) = 0;
  virtual void on_view(const UnitView& view) = 0;
};

}  // namespace mpm::live
