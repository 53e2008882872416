#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/record/channel_record.hpp"
#include "core/record/health_record.hpp"
#include "core/signal/aligner.hpp"
#include "daemon/bus/trouble.hpp"
#include "daemon/bus/unit_inputs.hpp"
#include "daemon/live/trouble_log.hpp"
#include "daemon/report/unit_monitor.hpp"
#include "idl/sample_view.hpp"

namespace mpm::live {

/// What is wrong with a unit apart from its channels, and what health (NE 107) that and its alarms
/// make.
class UnitHealth {
 public:
  using Clock = std::chrono::steady_clock;

  UnitHealth(const config::UnitConfig& unit, Clock::time_point now);

  /// The event loop goes on, which it does five times a second at least. Before all others; the
  /// first time after a start, however long that took.
  void go_on(Clock::time_point now);
  /// `wall_ns`: UTC, when it came.
  void push(const idl::SampleView& sample, std::int64_t wall_ns);
  /// What the control system says its values are, or that nobody says it of `kind` any more.
  void hear(const mpm_Layout& layout, std::uint64_t writer) { inputs_.hear(layout, writer); }
  void forget_layout(const char* kind, std::uint64_t writer) {
    inputs_.forget_layout(kind, writer);
  }
  /// The record is of that sample from now on.
  void move_to(std::int64_t interval, std::int64_t source_time_ns);
  /// What has come by now, and how the channels stand, without a look at what is wrong.
  void count(const AlignerCounters& aligner, report::UnitMonitor& monitor);
  void count(const std::vector<ChannelRecord>& channels);
  /// What a process before this one took, and what it missed is no news.
  void recall(const AlignerCounters& aligner);
  /// Between that and what this process takes, of these source times, so many intervals are
  /// missing.
  void missed(std::uint64_t intervals, std::int64_t from_ns, std::int64_t until_ns);

  /// What there is to be judged at one moment.
  struct Found {
    const AlignerCounters& aligner;
    report::UnitMonitor& monitor;  // makes its records when asked
    std::uint64_t unknown_unit = 0;
    const bus::Surroundings& around;
    std::vector<bus::Trouble> others = {};  ///< what is seen elsewhere
    std::string in_front = {};              ///< of the detail
    std::uint32_t silenced_alarms = 0;      ///< of the active ones
  };
  /// Logs what begins and what is over.
  const HealthRecord& judge(const Found& found, std::int64_t wall_s);

  [[nodiscard]] const HealthRecord& record() const { return record_; }
  /// At the last judgement, the worst first.
  [[nodiscard]] const std::vector<bus::Trouble>& troubles() const { return troubles_; }
  /// The worst of them, in words; empty if there is none.
  [[nodiscard]] const std::string& trouble_text() const { return trouble_text_; }
  [[nodiscard]] bool wants_endpoints(Clock::time_point now) const {
    return inputs_.wants_endpoints(now);
  }

 private:
  [[nodiscard]] std::vector<bus::Trouble> find_troubles(const Found& found) const;
  [[nodiscard]] std::vector<bus::Trouble> input_troubles(const bus::Surroundings& around) const;
  void add_simulated(report::UnitMonitor& monitor, std::vector<bus::Trouble>& troubles) const;
  [[nodiscard]] bool pauses(SignalKind kind) const;
  void note_incomplete(const AlignerCounters& aligner);
  void keep_while_paused();
  void decide();

  const config::UnitConfig& unit_;
  bus::UnitInputs inputs_;
  TroubleLog trouble_log_;
  std::vector<bus::Trouble> troubles_;
  std::vector<bus::Trouble> while_data_came_;  // the last of them
  std::string trouble_text_;
  HealthRecord record_;
  Clock::time_point now_;
  std::optional<Clock::time_point> framed_at_;  // when the last frame was seen
  bool goes_on_ = false;
  std::optional<Clock::time_point> stood_still_;  // when this process went on
  Clock::duration stood_still_for_{};
  std::optional<Clock::time_point> incomplete_at_;         // the last time that a frame was
  std::vector<std::string> incomplete_without_;            // topics, then
  std::array<std::uint64_t, kSignalKindCount> without_{};  // frames, as last counted
  std::optional<Clock::time_point> missed_at_;
  std::string missed_;
};

}  // namespace mpm::live
