#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "daemon/report/health.hpp"
#include "daemon/report/records.hpp"
#include "idl/reader.hpp"
#include "idl/wait_set.hpp"

namespace mpm::bus {

/// The alarm of a channel as it stands, told apart from a change of it.
struct AlarmStateRecord {
  report::AlarmRecord alarm;
};

/// The daemon that wrote this is gone; what it said last no longer holds.
struct MonitorGone {
  std::string unit;
};

/// The order of a unit's tags, from the control system.
struct LayoutRecord {
  std::string unit;
  std::string kind;
  std::vector<std::string> tags;
};

using Output = std::variant<LayoutRecord, report::ChannelRecord, AlarmStateRecord,
                            report::AlarmRecord, report::HealthRecord, MonitorGone>;

/// Reads what daemons say, in the order in which they said it.
class OutputReaders {
 public:
  enum class Scope {
    kEverything,
    kAlarms,  ///< the alarm topics only: no other reader exists
  };
  explicit OutputReaders(const idl::Participant& participant, Scope scope = Scope::kEverything);

  void attach_to(idl::WaitSet& wait_set) const;
  /// Takes what is there; valid until the next call.
  [[nodiscard]] const std::vector<Output>& take();

 private:
  void add(std::int64_t written_ns, Output output);

  idl::Reader<mpm_Alarm> alarm_;
  idl::Reader<mpm_AlarmEvent> alarm_event_;
  std::optional<idl::Reader<mpm_Layout>> layout_;
  std::optional<idl::Reader<mpm_ChannelStatus>> channel_status_;
  std::optional<idl::Reader<mpm_Health>> health_;
  std::vector<std::pair<std::int64_t, Output>> taken_;
  std::vector<Output> sorted_;
};

}  // namespace mpm::bus
