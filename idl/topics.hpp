#pragma once

#include <array>
#include <tuple>

#include "core/record/alarm_record.hpp"
#include "core/record/channel_record.hpp"
#include "core/record/command_record.hpp"
#include "core/record/controller_alarm_record.hpp"
#include "core/record/health_record.hpp"
#include "core/record/performance_record.hpp"
#include "core/signal/frame.hpp"
#include "idl/qos.hpp"
#include "mpm.h"

namespace mpm::idl {

inline constexpr const char* kLayoutTopic = "mpm/layout";
inline constexpr const char* kChannelStatusTopic = "mpm/channel_status";
inline constexpr const char* kAlarmTopic = "mpm/alarm";
inline constexpr const char* kAlarmEventTopic = "mpm/alarm_event";
inline constexpr const char* kControllerAlarmTopic = "mpm/controller_alarm";
inline constexpr const char* kCommandTopic = "mpm/command";
inline constexpr const char* kCommandReplyTopic = "mpm/command_reply";
inline constexpr const char* kHealthTopic = "mpm/health";
inline constexpr const char* kPerformanceTopic = "mpm/performance";
inline constexpr const char* kRoleTopic = "mpm/role";

/// The kinds of signals that have a DDS topic; kAux comes from files only.
inline constexpr std::array kTopicKinds = {SignalKind::kMv,       SignalKind::kDv,
                                           SignalKind::kCv,       SignalKind::kPrediction,
                                           SignalKind::kSetpoint, SignalKind::kRaw};

/// "mpm/mv" ...
[[nodiscard]] const char* sample_topic(SignalKind kind);
/// "mv" ...: key of `mpm_Layout`.
[[nodiscard]] const char* kind_name(SignalKind kind);

template <class T>
struct TopicType;
template <>
struct TopicType<mpm_Sample> {
  static constexpr const dds_topic_descriptor_t* descriptor() { return &mpm_Sample_desc; }
};
template <>
struct TopicType<mpm_Layout> {
  static constexpr const dds_topic_descriptor_t* descriptor() { return &mpm_Layout_desc; }
};
template <>
struct TopicType<mpm_ChannelStatus> {
  static constexpr const dds_topic_descriptor_t* descriptor() { return &mpm_ChannelStatus_desc; }
};
template <>
struct TopicType<mpm_Alarm> {
  static constexpr const dds_topic_descriptor_t* descriptor() { return &mpm_Alarm_desc; }
};
template <>
struct TopicType<mpm_AlarmEvent> {
  static constexpr const dds_topic_descriptor_t* descriptor() { return &mpm_AlarmEvent_desc; }
};
template <>
struct TopicType<mpm_ControllerAlarm> {
  static constexpr const dds_topic_descriptor_t* descriptor() { return &mpm_ControllerAlarm_desc; }
};
template <>
struct TopicType<mpm_Command> {
  static constexpr const dds_topic_descriptor_t* descriptor() { return &mpm_Command_desc; }
};
template <>
struct TopicType<mpm_CommandReply> {
  static constexpr const dds_topic_descriptor_t* descriptor() { return &mpm_CommandReply_desc; }
};
template <>
struct TopicType<mpm_Health> {
  static constexpr const dds_topic_descriptor_t* descriptor() { return &mpm_Health_desc; }
};
template <>
struct TopicType<mpm_Performance> {
  static constexpr const dds_topic_descriptor_t* descriptor() { return &mpm_Performance_desc; }
};
template <>
struct TopicType<mpm_Role> {
  static constexpr const dds_topic_descriptor_t* descriptor() { return &mpm_Role_desc; }
};

/// The topic that carries a kind of record: the type of its samples, its name and profile (as in
/// qos.hpp), and how many samples a reader takes at once. They come instance by instance: only a
/// batch that holds all there is can be put back into the order of writing.
template <class Record>
struct OutputTopic;
template <>
struct OutputTopic<ChannelRecord> {
  using Sample = mpm_ChannelStatus;
  static constexpr const char* kName = kChannelStatusTopic;
  static constexpr auto kWriterQos = channel_status_writer_qos;
  static constexpr auto kReaderQos = channel_status_reader_qos;
  static constexpr auto kEveryChangeQos = channel_status_reader_qos;
  static constexpr int kBatch = 16384;
};
template <>
struct OutputTopic<AlarmStateRecord> {
  using Sample = mpm_Alarm;
  static constexpr const char* kName = kAlarmTopic;
  static constexpr auto kWriterQos = alarm_qos;
  static constexpr auto kReaderQos = alarm_qos;
  static constexpr auto kEveryChangeQos = late_joiner_reader_qos;
  static constexpr int kBatch = 64;
};
template <>
struct OutputTopic<AlarmRecord> {
  using Sample = mpm_AlarmEvent;
  static constexpr const char* kName = kAlarmEventTopic;
  static constexpr auto kWriterQos = alarm_event_writer_qos;
  static constexpr auto kReaderQos = alarm_event_reader_qos;
  static constexpr auto kEveryChangeQos = alarm_event_reader_qos;
  static constexpr int kBatch = 4096;
};
template <>
struct OutputTopic<HealthRecord> {
  using Sample = mpm_Health;
  static constexpr const char* kName = kHealthTopic;
  static constexpr auto kWriterQos = health_qos;
  static constexpr auto kReaderQos = health_qos;
  static constexpr auto kEveryChangeQos = late_joiner_reader_qos;
  static constexpr int kBatch = 64;
};
template <>
struct OutputTopic<ControllerAlarmRecord> {
  using Sample = mpm_ControllerAlarm;
  static constexpr const char* kName = kControllerAlarmTopic;
  static constexpr auto kWriterQos = alarm_qos;
  static constexpr auto kReaderQos = alarm_qos;
  static constexpr auto kEveryChangeQos = late_joiner_reader_qos;
  static constexpr int kBatch = 64;
};
template <>
struct OutputTopic<PerformanceRecord> {
  using Sample = mpm_Performance;
  static constexpr const char* kName = kPerformanceTopic;
  static constexpr auto kWriterQos = performance_qos;
  static constexpr auto kReaderQos = performance_qos;
  static constexpr auto kEveryChangeQos = late_joiner_reader_qos;
  static constexpr int kBatch = 64;
};

template <>
struct OutputTopic<CommandRecord> {
  using Sample = mpm_Command;
  static constexpr const char* kName = kCommandTopic;
  static constexpr auto kWriterQos = command_qos;
  static constexpr auto kReaderQos = command_qos;
  static constexpr auto kEveryChangeQos = command_qos;
  static constexpr int kBatch = 64;
};
template <>
struct OutputTopic<CommandReplyRecord> {
  using Sample = mpm_CommandReply;
  static constexpr const char* kName = kCommandReplyTopic;
  static constexpr auto kWriterQos = command_qos;
  static constexpr auto kReaderQos = command_qos;
  static constexpr auto kEveryChangeQos = command_qos;
  static constexpr int kBatch = 64;
};

/// All that the monitor says unasked. Of one frame the alarms follow the channels.
using OutputRecords = std::tuple<ChannelRecord, AlarmStateRecord, AlarmRecord,
                                 ControllerAlarmRecord, HealthRecord, PerformanceRecord>;

template <class Record>
using SampleOf = typename OutputTopic<Record>::Sample;

}  // namespace mpm::idl
