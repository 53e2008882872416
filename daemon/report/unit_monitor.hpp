#pragma once

#include <cstdint>
#include <vector>

#include "config/unit_config.hpp"
#include "core/monitor/monitor.hpp"
#include "core/record/alarm_record.hpp"
#include "core/record/channel_record.hpp"

namespace mpm {
class Archive;
}

namespace mpm::report {

/// Per CV, whether its prediction may come with the frames.
[[nodiscard]] std::vector<bool> predictions_of(const config::UnitConfig& config);

/// The monitor of one unit, speaking in tags: frames in, records out. The daemon and `mpm detect`
/// both go through here, so that the same frames give the same records.
class UnitMonitor {
 public:
  explicit UnitMonitor(const config::UnitConfig& config);

  void push(const Frame& frame);

  /// As `Monitor::stand`. `channel`: its place in `channels()`.
  void stand(std::size_t channel);

  /// All channels after the last frame; inputs outermost, CVs innermost.
  [[nodiscard]] const std::vector<ChannelRecord>& channels() {
    if (!filled_) fill();
    return channels_;
  }
  /// Alarms that the last frame changed.
  [[nodiscard]] const std::vector<AlarmRecord>& alarms() const { return alarms_; }
  [[nodiscard]] const MonitorCounters& counters() const { return monitor_.counters(); }
  /// What the records say, by index, without making them.
  [[nodiscard]] const Monitor& monitor() const { return monitor_; }
  /// Of the last frame.
  [[nodiscard]] std::int64_t interval() const { return interval_; }
  [[nodiscard]] std::int64_t source_time_ns() const { return source_time_ns_; }

  void archive(Archive& a);

 private:
  void fill();
  void tell_alarms();

  config::UnitConfig config_;
  Monitor monitor_;
  std::int64_t interval_ = 0;  // of the last frame
  std::int64_t source_time_ns_ = 0;
  bool filled_ = false;  // the records say what the monitor does
  std::vector<ChannelRecord> channels_;
  std::vector<AlarmRecord> alarms_;
};

}  // namespace mpm::report
