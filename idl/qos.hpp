#pragma once

#include <dds/dds.h>

#include <memory>

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

/// A reader of what others write: matches any writer, and drops the oldest samples of an instance
/// where it cannot follow.
[[nodiscard]] Qos foreign_reader_qos();

}  // namespace mpm::idl
