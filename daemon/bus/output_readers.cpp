#include "daemon/bus/output_readers.hpp"

#include <algorithm>

#include "daemon/bus/output_samples.hpp"

namespace mpm::bus {
namespace {

// Samples come instance by instance. Only a batch that holds all there is can be put back into the
// order of writing, so it is large.
constexpr int kStatusBatch = 16384;
constexpr int kEventBatch = 4096;

LayoutRecord record_of(const mpm_Layout& layout) {
  LayoutRecord record{
      layout.unit == nullptr ? "" : layout.unit, layout.kind == nullptr ? "" : layout.kind, {}};
  for (std::uint32_t i = 0; i < layout.tags._length; ++i)
    record.tags.emplace_back(layout.tags._buffer[i] == nullptr ? "" : layout.tags._buffer[i]);
  return record;
}

}  // namespace

OutputReaders::OutputReaders(const idl::Participant& participant, Scope scope)
    : alarm_(participant, idl::kAlarmTopic, idl::alarm_qos()),
      alarm_event_(participant, idl::kAlarmEventTopic, idl::alarm_event_reader_qos(), kEventBatch) {
  if (scope == Scope::kAlarms) return;
  layout_.emplace(participant, idl::kLayoutTopic, idl::layout_qos());
  channel_status_.emplace(participant, idl::kChannelStatusTopic, idl::channel_status_reader_qos(),
                          kStatusBatch);
  health_.emplace(participant, idl::kHealthTopic, idl::health_qos());
}

void OutputReaders::attach_to(idl::WaitSet& wait_set) const {
  wait_set.attach(alarm_.readable());
  wait_set.attach(alarm_event_.readable());
  if (layout_) wait_set.attach(layout_->readable());
  if (channel_status_) wait_set.attach(channel_status_->readable());
  if (health_) wait_set.attach(health_->readable());
}

void OutputReaders::add(std::int64_t written_ns, Output output) {
  taken_.emplace_back(written_ns, std::move(output));
}

const std::vector<Output>& OutputReaders::take() {
  taken_.clear();
  // In this order, so that of what one frame caused the channels are never behind the alarms.
  const auto on_health = [this](const mpm_Health& sample, const dds_sample_info_t& info) {
    if (info.valid_data)
      add(info.source_timestamp, record_of(sample));
    else if (sample.unit != nullptr)
      add(info.source_timestamp, MonitorGone{sample.unit});
  };
  if (health_) health_->take_with_info(on_health);
  alarm_event_.take_with_info([this](const mpm_AlarmEvent& sample, const dds_sample_info_t& info) {
    if (info.valid_data) add(info.source_timestamp, record_of(sample));
  });
  alarm_.take_with_info([this](const mpm_Alarm& sample, const dds_sample_info_t& info) {
    if (info.valid_data) add(info.source_timestamp, AlarmStateRecord{record_of(sample)});
  });
  const auto on_status = [this](const mpm_ChannelStatus& sample, const dds_sample_info_t& info) {
    if (info.valid_data) add(info.source_timestamp, record_of(sample));
  };
  if (channel_status_) channel_status_->take_with_info(on_status);
  const auto on_layout = [this](const mpm_Layout& sample, const dds_sample_info_t& info) {
    if (info.valid_data) add(0, record_of(sample));  // first: it orders the rest
  };
  if (layout_) layout_->take_with_info(on_layout);
  std::stable_sort(taken_.begin(), taken_.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  sorted_.clear();
  for (auto& [written_ns, output] : taken_) sorted_.push_back(std::move(output));
  return sorted_;
}

}  // namespace mpm::bus
