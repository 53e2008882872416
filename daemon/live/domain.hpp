#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "daemon/host/rate_limiter.hpp"
#include "daemon/live/command_gate.hpp"
#include "daemon/live/trouble_log.hpp"
#include "daemon/live/unit_pipeline.hpp"
#include "idl/discovery.hpp"
#include "idl/output_writers.hpp"
#include "idl/sample_readers.hpp"
#include "idl/unit_choice.hpp"

namespace mpm::live {

/// One DDS domain with the units that live on it. Reads the input topics and never writes them.
class Domain {
 public:
  using Clock = std::chrono::steady_clock;

  /// `units`: of which samples and commands are taken; each is to be added. `gate`: lets commands
  /// in, and must outlive the domain. `rank`: as Role's, where the units are shared with other
  /// monitors; none: they are not.
  Domain(const idl::DomainOptions& options, const std::vector<std::string>& units,
         CommandGate& gate, std::optional<int> rank);

  UnitPipeline& add_unit(const config::UnitConfig& unit, SampleJournal* samples,
                         Clock::time_point now);
  void attach_to(idl::WaitSet& wait_set) const;
  /// Takes one batch of each topic.
  void poll(Clock::time_point now);
  /// Which units this process speaks for, where it shares them with others; before each `poll`, and
  /// `poll` itself while it lasts.
  void settle_roles(Clock::time_point now);
  void tick(Clock::time_point now);
  /// Nothing waits, until `disturbed` says otherwise. True where a unit made use of it.
  bool rest(const std::function<bool()>& disturbed);

  [[nodiscard]] const std::map<std::string, std::unique_ptr<UnitPipeline>, std::less<>>& units()
      const {
    return units_;
  }

 private:
  /// What one of several monitors hears of the others.
  struct Others {
    Others(const idl::Participant& participant, idl::UnitChoice* units, int rank);

    int rank;
    idl::Reader<mpm_Role> roles;
    idl::Reader<mpm_Alarm> alarms;
    idl::Reader<mpm_AlarmEvent> events;
    idl::Reader<mpm_ControllerAlarm> controllers;
  };

  void take_commands(Clock::time_point now);
  void take_told();
  void report_unknown(Clock::time_point now);
  void hear_other_monitors(Clock::time_point now);
  void forget_strangers(Clock::time_point now);
  void look_around(Clock::time_point now);

  idl::Participant participant_;
  idl::Discovery discovery_;
  // What of the words of others is not ours is nobody's trouble; samples are.
  idl::UnitChoice sampled_, spoken_of_, commanded_;
  idl::SampleReaders samples_;
  idl::Reader<mpm_Layout> layouts_;
  idl::Reader<mpm_Health> other_monitors_;
  idl::Reader<mpm_Command> commands_;
  idl::OutputWriter<CommandReplyRecord> replies_;
  idl::OutputWriters outputs_;
  std::optional<Others> others_;
  CommandGate& gate_;
  std::map<std::string, std::unique_ptr<UnitPipeline>, std::less<>> units_;
  bus::Surroundings around_;
  Clock::time_point next_look_{}, next_forgetting_{}, next_roles_{};
  std::uint64_t unknown_unit_ = 0;
  TroubleLog unknown_log_;
  host::RateLimiter command_log_limit_;
  host::RateLimiter command_limit_;
};

}  // namespace mpm::live
