#include "idl/qos.hpp"

namespace mpm::idl {
namespace {

// Samples that a control system's writer keeps for a reader that does not answer. Also how many a
// reader of a real-time writer may lag behind before it loses some.
constexpr int kSampleDepth = 256;
// Per topic, all units together: bounds the memory of a reader that is not drained; what does not
// fit stays with the writer, which resends it.
constexpr int kReaderLimit = 8192;
// Status samples per channel that wait for a slow reader. Late joiners get the last one only.
constexpr int kStatusDepth = 1024;
constexpr int kStatusReaderLimit = 262144;
// Alarm changes per channel that a late joiner gets to see.
constexpr int kEventDepth = 64;
// Commands to a unit that wait; nobody types faster.
constexpr int kCommandDepth = 64;
constexpr int kForeignDepth = 4096;
constexpr int kNeighbourUnits = 1024;

Qos reliable(dds_duration_t max_blocking_time) {
  Qos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, max_blocking_time);
  return qos;
}

// Output writers keep only the last samples, and such a writer never waits in Cyclone; this would
// bound the wait if one did.
constexpr dds_duration_t kOutputBlocking = DDS_MSECS(10);

Qos transient_local(int writer_depth, int late_joiner_depth) {
  Qos qos = reliable(kOutputBlocking);
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, writer_depth);
  // Without this service the whole history is kept for ever, whatever the resource limits say.
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, late_joiner_depth,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  // A monitor that stopped leaves its last word as "no writer" rather than wiping it out.
  dds_qset_writer_data_lifecycle(qos.get(), false);
  return qos;
}

Qos transient_local_reader(int max_samples) {
  Qos qos = reliable(kOutputBlocking);
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, 0);
  dds_qset_resource_limits(qos.get(), max_samples, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  return qos;
}

}  // namespace

Qos sample_writer_qos(WriterPace pace) {
  Qos qos = reliable(DDS_SECS(10));
  if (pace == WriterPace::kLossless)
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, 0);
  else
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kSampleDepth);
  return qos;
}

Qos sample_reader_qos() {
  Qos qos = reliable(DDS_SECS(10));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, 0);
  dds_qset_resource_limits(qos.get(), kReaderLimit, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  return qos;
}

Qos layout_qos() { return transient_local(1, 1); }
Qos alarm_qos() { return transient_local(1, 1); }
Qos health_qos() { return transient_local(1, 1); }
Qos performance_qos() { return transient_local(1, 1); }
Qos late_joiner_reader_qos() { return transient_local_reader(kReaderLimit); }
Qos channel_status_writer_qos() { return transient_local(kStatusDepth, 1); }
Qos channel_status_reader_qos() { return transient_local_reader(kStatusReaderLimit); }
Qos alarm_event_writer_qos() { return transient_local(kEventDepth, kEventDepth); }
Qos alarm_event_reader_qos() { return transient_local_reader(kStatusReaderLimit); }

Qos command_qos() {
  Qos qos = reliable(kOutputBlocking);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kCommandDepth);
  return qos;
}

// Best effort: no writer waits for a reader that is full.
Qos neighbour_health_qos() {
  Qos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
  dds_qset_resource_limits(qos.get(), DDS_LENGTH_UNLIMITED, kNeighbourUnits, DDS_LENGTH_UNLIMITED);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return qos;
}

Qos role_reader_qos() {
  Qos qos(dds_create_qos());
  // What is lost is said again at once.
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
  dds_qset_ownership(qos.get(), DDS_OWNERSHIP_EXCLUSIVE);
  dds_qset_liveliness(qos.get(), DDS_LIVELINESS_MANUAL_BY_TOPIC,
                      std::chrono::nanoseconds(kRoleLease).count());
  return qos;
}

Qos role_writer_qos(const std::string& unit, int strength) {
  Qos qos = role_reader_qos();
  dds_qset_userdata(qos.get(), unit.data(), unit.size());
  dds_qset_ownership_strength(qos.get(), strength);
  return qos;
}

bool set_strength(dds_entity_t writer, int strength) {
  const Qos qos(dds_create_qos());
  dds_qset_ownership_strength(qos.get(), strength);
  return dds_set_qos(writer, qos.get()) == DDS_RETCODE_OK;
}

Qos others_alarm_qos() {
  Qos qos = alarm_qos();
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return qos;
}

Qos others_alarm_event_qos() {
  Qos qos = transient_local(1, 1);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return qos;
}

Qos foreign_reader_qos() {
  Qos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kForeignDepth);
  return qos;
}

}  // namespace mpm::idl
