#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "config/unit_config.hpp"
#include "core/performance/performance_window.hpp"
#include "core/signal/aligner.hpp"
#include "daemon/bus/trouble.hpp"
#include "daemon/bus/unit_inputs.hpp"
#include "daemon/files/unit_rules.hpp"
#include "daemon/history/journal.hpp"
#include "daemon/host/rate_limiter.hpp"
#include "daemon/live/checkpoints.hpp"
#include "daemon/live/live_diagnosis.hpp"
#include "daemon/live/neighbours.hpp"
#include "daemon/live/sample_journal.hpp"
#include "daemon/live/told_alarms.hpp"
#include "daemon/live/unit_alarms.hpp"
#include "daemon/live/unit_health.hpp"
#include "daemon/live/unit_observer.hpp"
#include "daemon/live/unit_outputs.hpp"
#include "daemon/live/unit_samples.hpp"
#include "daemon/report/unit_monitor.hpp"
#include "idl/sample_view.hpp"

namespace mpm::live {

/// Thrown where somebody wants the process to end while samples from before are taken again.
struct RecallStopped : std::exception {};

/// One unit from samples to outputs: aligner -> calculated signals -> monitor -> records -> DDS and
/// journal, and what its alarms are diagnosed to come from.
class UnitPipeline {
 public:
  using Clock = std::chrono::steady_clock;

  /// `samples`: takes every sample's records; may be null. The others must outlive the pipeline.
  UnitPipeline(const config::UnitConfig& config, const idl::OutputWriters& outputs,
               SampleJournal* samples, Clock::time_point now);
  ~UnitPipeline();
  /// From now on what is to be known later is kept there.
  void keep(history::Journal journal) { journal_.emplace(std::move(journal)); }
  /// Takes again what a process before this one took, and tells nobody: statistics, alarms and
  /// what a diagnosis needs are as they were. From now on what is taken is kept there. After
  /// `diagnose_with`, before anything else is taken. Says what became of it, in words for the log.
  /// Throws RecallStopped once `stop`, if any, says so; then the pipeline is of no use.
  [[nodiscard]] std::string recall(const UnitSamples& samples, const std::function<bool()>& stop);
  /// From now on what happens to alarms is kept there, and what people did about them before holds.
  void keep(AlarmJournal& journal) {
    if (checkpoints_) journal.rest_on(config_.unit, checkpoints_->folder());
    alarms_.keep(journal, wall_ns());
  }
  /// Tells readers how the alarms stand, at the start.
  void announce();
  /// From now on it is one of several, and says nothing until it is the one that speaks. Before
  /// `announce`.
  void share(std::unique_ptr<Role> role, Clock::time_point now);
  /// Whether another monitor speaks for this unit.
  [[nodiscard]] bool stands_by() const { return outputs_.silent(); }
  /// Those with a role only. Often, and before anything of the unit's is taken: says that it is
  /// there, then, after what others say has come in by `hear_role`, speaks or stands by.
  void say_role(Clock::time_point now) { neighbours_.role()->say(now, wall_ns()); }
  void hear_role(const mpm_Role& sample, std::uint64_t writer) {
    neighbours_.role()->hear(sample, writer);
  }
  void settle_role(Clock::time_point now);
  /// Another monitor has told this of the unit's alarms.
  void hear_told(AlarmRecord event);
  void hear_told(AlarmStateRecord state);
  void hear_told(ControllerAlarmRecord controller) { told_.controller = std::move(controller); }
  /// A person's command to this unit: `admitted`, or why not.
  CommandReply obey(const CommandRecord& record,
                    const std::variant<AlarmCommand, std::string>& admitted);
  CommandReply obey(const AlarmCommand& command);
  /// Keeps that somebody who may not gave a command; of many the first few a minute.
  void refuse(const AlarmCommand& command, const std::string& action, const std::string& why);
  [[nodiscard]] const UnitAlarms& alarms() const { return alarms_; }
  /// UTC.
  [[nodiscard]] static std::int64_t wall_ns();
  /// From now on alarms are diagnosed, if the unit file wants that. `asker`: no other unit's.
  void diagnose_with(DiagnosisWorker& worker, int asker);
  /// From now on it looks on; null: nobody does.
  void show_to(UnitObserver* observer) { observer_ = observer; }
  UnitPipeline(const UnitPipeline&) = delete;  // the aligner's sink points here
  UnitPipeline& operator=(const UnitPipeline&) = delete;

  void push(const idl::SampleView& sample, Clock::time_point now);
  /// What the control system says its values are, or that nobody says it of `kind` any more.
  void hear(const mpm_Layout& layout, std::uint64_t writer) { health_.hear(layout, writer); }
  void forget_layout(const char* kind, std::uint64_t writer) {
    health_.forget_layout(kind, writer);
  }
  /// As Neighbours::hear.
  void hear_other_monitor(std::uint64_t writer, std::string name, Clock::time_point now) {
    neighbours_.hear(writer, std::move(name), now);
  }
  void hear_no_other_monitor() { neighbours_.hear_none(); }
  /// Reports cannot be kept, and why; empty: they can.
  void set_report_problem(std::string problem) {
    if (diagnosis_) diagnosis_->set_file_problem(std::move(problem));
  }
  /// Until when this process may take part on the bus, UTC; told a month ahead.
  void set_keys_until(std::time_t until) { keys_until_ = until; }
  /// Gives up waiting where nothing comes, and publishes the health about once a second.
  void tick(Clock::time_point now, std::uint64_t unknown_unit, const bus::Surroundings& around);
  /// As Checkpoints::rest.
  bool rest(const std::function<bool()>& disturbed) {
    return checkpoints_ && checkpoints_->rest(disturbed);
  }
  /// True while the list of endpoints in the surroundings is of use.
  [[nodiscard]] bool wants_endpoints(Clock::time_point now) const {
    return health_.wants_endpoints(now) || neighbours_.wants_endpoints();
  }

  [[nodiscard]] const HealthRecord& health() const { return health_.record(); }
  /// What is wrong, in words, apart from the alarms; empty if nothing is.
  [[nodiscard]] const std::string& trouble_text() const { return health_.trouble_text(); }

 private:
  void on_frame(const Frame& frame);
  void recall_frame(const Frame& frame);
  void archive(Archive& a);
  [[nodiscard]] std::vector<std::string> alarm_texts();
  [[nodiscard]] bool tell_sizes();
  void go_on(Clock::time_point now);
  void note_absence(const Frame& frame);
  void report(const idl::SampleView& sample, const AlignerCounters& before);
  void report_restart(const AlignerCounters& before);
  /// Over what there is of the window.
  [[nodiscard]] PerformanceRecord performance();
  void publish_performance();
  void publish_diagnosis();
  void publish_alarms_again();
  void publish_health(std::uint64_t unknown_unit, const bus::Surroundings& around);
  [[nodiscard]] std::vector<bus::Trouble> keeping_troubles() const;
  [[nodiscard]] std::string stands_by_text() const;
  void show();

  config::UnitConfig config_;
  UnitOutputs outputs_;
  SampleJournal* samples_;
  std::optional<history::Journal> journal_;
  std::optional<Checkpoints> checkpoints_;
  bool recalling_ = false;
  /// Between what another process took before this one and what this one takes.
  struct Absence {
    std::uint64_t missing = 0;             // before it
    std::int64_t from_ns = 0;              // source time
    std::optional<std::int64_t> until_ns;  // likewise, of the first sample
  };
  std::optional<Absence> absence_;  // until it is over, and told
  report::UnitMonitor monitor_;
  UnitAlarms alarms_;
  PerformanceWindow performance_;
  files::UnitRules rules_;
  Frame calculated_;  // a copy of the aligner's, with what is calculated
  Aligner aligner_;
  std::optional<LiveDiagnosis> diagnosis_;
  UnitObserver* observer_ = nullptr;
  Clock::duration patience_;  // without a frame while something waits
  UnitHealth health_;
  Neighbours neighbours_;
  ToldAlarms told_;
  Clock::time_point now_;  // of the event loop
  Clock::time_point last_frame_;
  Clock::time_point next_health_;
  std::optional<std::time_t> keys_until_;
  host::RateLimiter refused_limit_, beyond_limit_, output_limit_, restart_limit_;
  host::RateLimiter refusal_limit_;
};

}  // namespace mpm::live
