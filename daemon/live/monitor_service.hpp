#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "daemon/host/command_token.hpp"
#include "daemon/host/notifier.hpp"
#include "daemon/live/alarm_journal.hpp"
#include "daemon/live/command_gate.hpp"
#include "daemon/live/command_queue.hpp"
#include "daemon/live/domain.hpp"

namespace mpm::live {

struct ServiceOptions {
  std::string journal;                         ///< folder; empty: none
  std::uint64_t journal_keep = 1'000'000'000;  ///< bytes, of all units together
  std::string sample_journal;                  ///< file of every sample's records; empty: none
  std::string alarm_journal;                   ///< file of all that happens to alarms; empty: none
  std::string samples;  ///< folder of the last samples of each unit, for a restart; empty: none
  std::optional<host::CommandToken> token;  ///< of those who may give commands; none: nobody may
  bool use_environment = false;  ///< CYCLONEDDS_URI instead of the unit files' DDS settings
  int first_asker = 0;           ///< of diagnoses: above those of a service before on this worker
  std::string report_problem;    ///< why reports of diagnoses cannot be kept; empty: they can
  /// Who looks on at a unit, null: nobody; may be empty. They must outlive the service.
  std::function<UnitObserver*(const config::UnitConfig&)> observer;
  CommandQueue* commands = nullptr;  ///< to be answered by the loop; may be null
  /// Whether to give up while samples from before are taken again, which may take long; asked from
  /// several threads. May be empty: never.
  std::function<bool()> stop;
  std::optional<int> standby_rank;  ///< as Role's; none: all units are this process's alone
};

/// All units of a daemon and the loop that drives them. Everything but the diagnoses happens in the
/// thread that calls `run`; Cyclone's own threads only fill the readers.
class MonitorService {
 public:
  /// `worker` diagnoses alarms and must outlive the service. Throws if DDS or the journal cannot be
  /// set up, and RecallStopped.
  MonitorService(const std::vector<config::UnitConfig>& units, const ServiceOptions& options,
                 DiagnosisWorker& worker);

  /// Until `stop()` says so, which is asked at least five times a second.
  void run(const std::function<bool()>& stop);
  /// What tells systemd how the service is.
  [[nodiscard]] host::Notifier& notifier() { return notifier_; }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] std::string status() const;
  /// Null where there is none of this name.
  [[nodiscard]] UnitPipeline* find(const std::string& unit) const;
  [[nodiscard]] CommandReply carry_out(const AlarmCommand& command);

  CommandGate gate_;
  std::optional<AlarmJournal> alarm_journal_;
  std::optional<SampleJournal> samples_;
  std::vector<std::unique_ptr<Domain>> domains_;  // one per distinct DDS setting
  idl::WaitSet wait_set_;
  std::chrono::milliseconds longest_wait_;
  CommandQueue* commands_;
  host::Notifier notifier_;
};

}  // namespace mpm::live
