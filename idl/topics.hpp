#pragma once

#include <array>

#include "core/signal/frame.hpp"
#include "mpm.h"

namespace mpm::idl {

inline constexpr const char* kLayoutTopic = "mpm/layout";
inline constexpr const char* kChannelStatusTopic = "mpm/channel_status";
inline constexpr const char* kAlarmTopic = "mpm/alarm";
inline constexpr const char* kAlarmEventTopic = "mpm/alarm_event";
inline constexpr const char* kHealthTopic = "mpm/health";

/// The kinds of signals that have a DDS topic; kAux comes from files only.
inline constexpr std::array kTopicKinds = {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv,
                                           SignalKind::kPrediction, SignalKind::kSetpoint};

/// "mpm/mv" ...
[[nodiscard]] const char* sample_topic(SignalKind kind);
/// "mv" ...: key of `mpm_Layout`.
[[nodiscard]] const char* kind_name(SignalKind kind);

template <class T>
struct TopicType;
template <>
struct TopicType<mpm_Sample> {
  static const dds_topic_descriptor_t* descriptor() { return &mpm_Sample_desc; }
};
template <>
struct TopicType<mpm_Layout> {
  static const dds_topic_descriptor_t* descriptor() { return &mpm_Layout_desc; }
};
template <>
struct TopicType<mpm_ChannelStatus> {
  static const dds_topic_descriptor_t* descriptor() { return &mpm_ChannelStatus_desc; }
};
template <>
struct TopicType<mpm_Alarm> {
  static const dds_topic_descriptor_t* descriptor() { return &mpm_Alarm_desc; }
};
template <>
struct TopicType<mpm_AlarmEvent> {
  static const dds_topic_descriptor_t* descriptor() { return &mpm_AlarmEvent_desc; }
};
template <>
struct TopicType<mpm_Health> {
  static const dds_topic_descriptor_t* descriptor() { return &mpm_Health_desc; }
};

}  // namespace mpm::idl
