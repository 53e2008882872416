#include "idl/unit_publisher.hpp"

#include <thread>

#include "idl/layout_sample.hpp"
#include "idl/sample_view.hpp"

namespace mpm::idl {
namespace {

using Clock = std::chrono::steady_clock;

std::chrono::nanoseconds left_until(Clock::time_point deadline) {
  return std::max(deadline - Clock::now(), Clock::duration::zero());
}

}  // namespace

UnitPublisher::UnitPublisher(const Participant& participant, UnitLayout layout, WriterPace pace)
    : layout_(std::move(layout)), layout_writer_(participant, kLayoutTopic, layout_qos()) {
  const Qos qos = sample_writer_qos(pace);
  for (const SignalKind kind : kTopicKinds)
    if (!layout_[kind].tags.empty())
      writers_[static_cast<std::size_t>(kind)].emplace(participant, sample_topic(kind), qos);
  write_layout();
}

void UnitPublisher::write_layout() const {
  for (const SignalKind kind : kTopicKinds) {
    const SignalLayout& signals = layout_[kind];
    if (signals.tags.empty()) continue;
    const LayoutSample sample(layout_.unit, kind_name(kind), layout_.sample_time_s, signals);
    if (!layout_writer_.write(sample.get())) throw Error("DDS: cannot write the layout");
  }
}

bool UnitPublisher::wait_for_readers(std::chrono::milliseconds timeout, int readers) const {
  const Clock::time_point deadline = Clock::now() + timeout;
  for (const auto& writer : writers_) {
    while (writer && writer->matched_readers() < readers) {
      if (Clock::now() >= deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  // A writer knows its reader a little before the reader knows the writer; what is written in
  // between is lost. A key-only sample of nobody is acknowledged by readers that know us.
  mpm_Sample probe{};
  probe.unit = const_cast<char*>("");
  for (const auto& writer : writers_)
    if (writer) dds_dispose(writer->get(), &probe);
  return flush(std::chrono::duration_cast<std::chrono::milliseconds>(left_until(deadline)));
}

bool UnitPublisher::publish(const Frame& frame) const {
  bool written = true;
  for (const SignalKind kind : kTopicKinds) {
    const auto& writer = writers_[static_cast<std::size_t>(kind)];
    if (writer && !writer->write(sample_of(layout_.unit.c_str(), frame, kind))) written = false;
  }
  return written;
}

bool UnitPublisher::flush(std::chrono::milliseconds timeout) const {
  const Clock::time_point deadline = Clock::now() + timeout;
  for (const auto& writer : writers_)
    if (writer && dds_wait_for_acks(writer->get(), left_until(deadline).count()) != DDS_RETCODE_OK)
      return false;
  return true;
}

}  // namespace mpm::idl
