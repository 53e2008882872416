#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "config/unit_config.hpp"
#include "core/signal/aligner.hpp"
#include "daemon/bus/output_writers.hpp"
#include "daemon/host/rate_limiter.hpp"
#include "daemon/live/journal.hpp"
#include "daemon/live/live_diagnosis.hpp"
#include "daemon/report/unit_monitor.hpp"
#include "idl/sample_view.hpp"

namespace mpm::live {

/// One unit from samples to outputs: aligner -> monitor -> records -> DDS and journal; and what its
/// alarms are diagnosed to come from.
class UnitPipeline {
 public:
  using Clock = std::chrono::steady_clock;

  /// `journal` may be null. The others must outlive the pipeline.
  UnitPipeline(const config::UnitConfig& config, const bus::OutputWriters& outputs,
               Journal* journal, Clock::time_point now);
  /// From now on alarms are diagnosed, if the unit file wants that. `asker`: no other unit's.
  void diagnose_with(DiagnosisWorker& worker, int asker);
  UnitPipeline(const UnitPipeline&) = delete;  // the aligner's sink points here
  UnitPipeline& operator=(const UnitPipeline&) = delete;

  void push(const idl::SampleView& sample, Clock::time_point now);
  /// What the control system says its values are; complains if the unit file says otherwise.
  void check_layout(const mpm_Layout& layout);
  /// Gives up waiting where nothing comes, and publishes the health about once a second.
  void tick(Clock::time_point now, std::uint64_t unknown_unit);

  [[nodiscard]] const report::HealthRecord& health() const { return health_; }

 private:
  void on_frame(const Frame& frame);
  void publish_initial_alarms();
  void publish_diagnosis();
  void publish_health(std::uint64_t unknown_unit);
  void judge_health();
  void report_refused(const idl::SampleView& sample);

  config::UnitConfig config_;
  const bus::OutputWriters& outputs_;
  Journal* journal_;
  report::UnitMonitor monitor_;
  Aligner aligner_;
  std::optional<LiveDiagnosis> diagnosis_;
  Clock::duration patience_;  // without a frame while something waits
  Clock::duration silence_;   // without any sample until that is a failure
  Clock::time_point now_;     // of the event loop
  Clock::time_point last_frame_;
  Clock::time_point last_sample_;
  Clock::time_point next_health_;
  report::HealthRecord health_;
  std::uint64_t incomplete_before_ = 0;  // at the last health
  std::string wrong_layout_;             // kinds whose layout differs; empty = none known
  host::RateLimiter refused_limit_, output_limit_, journal_limit_;
};

}  // namespace mpm::live
