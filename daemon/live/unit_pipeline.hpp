#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "config/unit_config.hpp"
#include "core/performance/performance_window.hpp"
#include "core/signal/aligner.hpp"
#include "daemon/bus/unit_inputs.hpp"
#include "daemon/files/calculator.hpp"
#include "daemon/history/journal.hpp"
#include "daemon/host/rate_limiter.hpp"
#include "daemon/live/live_diagnosis.hpp"
#include "daemon/live/role.hpp"
#include "daemon/live/sample_journal.hpp"
#include "daemon/live/sample_log.hpp"
#include "daemon/live/state_files.hpp"
#include "daemon/live/told_alarms.hpp"
#include "daemon/live/trouble_log.hpp"
#include "daemon/live/unit_alarms.hpp"
#include "daemon/live/unit_observer.hpp"
#include "daemon/live/unit_outputs.hpp"
#include "daemon/live/unit_samples.hpp"
#include "daemon/report/unit_monitor.hpp"
#include "idl/sample_view.hpp"

namespace mpm::live {

/// One unit from samples to outputs: aligner -> calculated signals -> monitor -> records -> DDS and
/// journal; what its alarms are diagnosed to come from; and what is wrong with its data, its
/// neighbours and its disk.
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
  [[nodiscard]] std::string recall(const UnitSamples& samples);
  /// From now on what happens to alarms is kept there, and what people did about them before holds.
  void keep(AlarmJournal& journal) {
    if (log_) journal.rest_on(config_.unit, log_->folder());
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
  void say_role(Clock::time_point now);
  void hear_role(const mpm_Role& sample, std::uint64_t writer) { role_->hear(sample, writer); }
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
  void hear(const mpm_Layout& layout) { inputs_.hear(layout); }
  void forget_layout(const char* kind) { inputs_.forget_layout(kind); }
  /// Another monitor of this unit said something: `name`, as idl::name_of; `writer`, as in
  /// idl::SampleInfo.
  void hear_other_monitor(std::uint64_t writer, std::string name, Clock::time_point now);
  /// All others have left.
  void hear_no_other_monitor() { other_monitors_.clear(); }
  /// Reports cannot be kept, and why; empty: they can.
  void set_report_problem(std::string problem) {
    if (diagnosis_) diagnosis_->set_file_problem(std::move(problem));
  }
  /// Until when this process may take part on the bus, UTC; told a month ahead.
  void set_keys_until(std::time_t until) { keys_until_ = until; }
  /// Gives up waiting where nothing comes, and publishes the health about once a second.
  void tick(Clock::time_point now, std::uint64_t unknown_unit, const bus::Surroundings& around);
  /// True while the list of endpoints in the surroundings is of use.
  [[nodiscard]] bool wants_endpoints(Clock::time_point now) const {
    return inputs_.wants_endpoints(now) || (role_ && role_->active());
  }

  [[nodiscard]] const HealthRecord& health() const { return health_; }
  /// What is wrong, in words, apart from the alarms; empty if nothing is.
  [[nodiscard]] const std::string& trouble_text() const { return trouble_text_; }

 private:
  void on_frame(const Frame& frame);
  void recall_frame(const Frame& frame);
  void archive(Archive& a);
  [[nodiscard]] std::uint64_t take_back_state();
  void keep_state(std::uint64_t file);
  [[nodiscard]] std::vector<std::string> alarm_texts();
  void go_on(Clock::time_point now);
  void publish_alarms_again();
  [[nodiscard]] bool other_monitor_speaks() const;
  [[nodiscard]] bool partner(const bus::Surroundings& around) const;
  [[nodiscard]] std::string monitors_text(const std::string& self) const;
  /// Over what there is of the window.
  [[nodiscard]] PerformanceRecord performance();
  void publish_performance();
  void publish_diagnosis();
  void count_channels();
  void publish_health(std::uint64_t unknown_unit, const bus::Surroundings& around);
  void show();
  [[nodiscard]] std::vector<bus::Trouble> troubles(const bus::Surroundings& around) const;
  void judge_health(const std::vector<bus::Trouble>& troubles);
  void report_refused(const idl::SampleView& sample);

  config::UnitConfig config_;
  UnitOutputs outputs_;
  SampleJournal* samples_;
  std::optional<history::Journal> journal_;
  std::optional<SampleLog> log_;
  std::optional<StateFiles> states_;
  std::uint64_t files_between_states_ = 1, next_state_ = 0;
  bool recalling_ = false;
  report::UnitMonitor monitor_;
  UnitAlarms alarms_;
  PerformanceWindow performance_;
  files::Calculator calculator_;
  Frame calculated_;  // a copy of the aligner's, with what is calculated
  Aligner aligner_;
  std::optional<LiveDiagnosis> diagnosis_;
  UnitObserver* observer_ = nullptr;
  Clock::duration patience_;  // without a frame while something waits
  bus::UnitInputs inputs_;
  TroubleLog trouble_log_;
  std::vector<bus::Trouble> troubles_;  // at the last health
  std::string trouble_text_;
  Clock::time_point now_;  // of the event loop
  Clock::time_point last_frame_;
  Clock::time_point next_health_;
  std::optional<Clock::time_point> stood_still_;  // when this process went on
  Clock::duration stood_still_for_{};
  /// Who, and when it was heard.
  struct OtherMonitor {
    std::string name;
    Clock::time_point heard;
  };
  std::map<std::uint64_t, OtherMonitor> other_monitors_;  // by writer
  bool other_monitor_spoke_ = false;                      // at the last health
  HealthRecord health_;
  std::unique_ptr<Role> role_;  // null: nobody shares the unit
  Clock::time_point role_begins_;
  ToldAlarms told_;
  std::optional<std::time_t> keys_until_;
  std::optional<Clock::time_point> incomplete_at_;  // the last time that a frame was
  host::RateLimiter refused_limit_, beyond_limit_, output_limit_, restart_limit_;
  host::RateLimiter refusal_limit_;
};

}  // namespace mpm::live
