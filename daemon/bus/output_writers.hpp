#pragma once

#include "daemon/report/health.hpp"
#include "daemon/report/records.hpp"
#include "idl/writer.hpp"

namespace mpm::bus {

/// Everything the daemon ever writes on one domain, all units. None of these waits for a reader;
/// false means that the sample could not be handed over.
class OutputWriters {
 public:
  explicit OutputWriters(const idl::Participant& participant);

  [[nodiscard]] bool write(const report::ChannelRecord& record) const;
  /// The change as an event, and as the state that late joiners get.
  [[nodiscard]] bool write(const report::AlarmRecord& record) const;
  /// The state only: what holds before the first change, and what is learnt of an alarm later.
  [[nodiscard]] bool write_state(const report::AlarmRecord& record) const;
  [[nodiscard]] bool write_event(const report::AlarmRecord& record) const;
  [[nodiscard]] bool write(const report::HealthRecord& record) const;

 private:
  idl::Writer<mpm_ChannelStatus> channel_status_;
  idl::Writer<mpm_Alarm> alarm_;
  idl::Writer<mpm_AlarmEvent> alarm_event_;
  idl::Writer<mpm_Health> health_;
};

}  // namespace mpm::bus
