#pragma once

#include <dds/dds.h>

#include <chrono>
#include <memory>
#include <string>

namespace mpm::idl {

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, QosDeleter>;

/// What a writer of input samples does when its readers cannot follow.
enum class WriterPace {
  kRealTime,  ///< never waits: a control system; a frozen reader loses the oldest samples
  kLossless,  ///< waits up to 10 s per sample: simulation and replay at full speed
};

/// The profile of every topic. All are reliable; readers match both paces of writers.
[[nodiscard]] Qos sample_writer_qos(WriterPace pace);
[[nodiscard]] Qos sample_reader_qos();
[[nodiscard]] Qos layout_qos();  // both sides, as the following
[[nodiscard]] Qos alarm_qos();
[[nodiscard]] Qos health_qos();
[[nodiscard]] Qos performance_qos();
/// A reader of these four that wants every change, not only the last one.
[[nodiscard]] Qos late_joiner_reader_qos();
[[nodiscard]] Qos channel_status_writer_qos();
[[nodiscard]] Qos channel_status_reader_qos();
[[nodiscard]] Qos alarm_event_writer_qos();
[[nodiscard]] Qos alarm_event_reader_qos();

/// Commands and replies, both sides: who was not there when it was said does not hear it.
[[nodiscard]] Qos command_qos();

/// A reader of what other monitors say of their health: nothing of its own participant's, the last
/// word only, of so many units at most.
[[nodiscard]] Qos neighbour_health_qos();

/// Of mpm/role: readers hear the writer of the greatest `strength` that is alive, which one is that
/// has written within `kRoleLease`.
inline constexpr std::chrono::milliseconds kRoleLease{125};
/// `unit`: whose, for who looks who stands by.
[[nodiscard]] Qos role_writer_qos(const std::string& unit, int strength);
[[nodiscard]] Qos role_reader_qos();
/// Of a writer of mpm/role that exists.
[[nodiscard]] bool set_strength(dds_entity_t writer, int strength);

/// Readers of what other monitors say of alarms: as those of everybody else, but for what this
/// process itself says.
[[nodiscard]] Qos others_alarm_qos();
[[nodiscard]] Qos others_alarm_event_qos();

/// A reader of what others write: matches any writer, and drops the oldest samples of an instance
/// where it cannot follow.
[[nodiscard]] Qos foreign_reader_qos();

}  // namespace mpm::idl
