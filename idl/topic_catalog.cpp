#include "idl/topic_catalog.hpp"

#include <algorithm>
#include <array>

#include "idl/topics.hpp"

namespace mpm::idl {

extern const std::string_view kIdlText;  // written by embed.cmake

namespace {

// One reader sees all that a late joiner may see and all that comes while it is busy.
Qos layout_writer(WriterPace) { return layout_qos(); }
Qos status_writer(WriterPace) { return channel_status_writer_qos(); }
Qos alarm_writer(WriterPace) { return alarm_qos(); }
Qos event_writer(WriterPace) { return alarm_event_writer_qos(); }
Qos health_writer(WriterPace) { return health_qos(); }

constexpr std::array kTopics = {
    KnownTopic{"mpm/mv", &mpm_Sample_desc, sample_reader_qos, sample_writer_qos, true},
    KnownTopic{"mpm/dv", &mpm_Sample_desc, sample_reader_qos, sample_writer_qos, true},
    KnownTopic{"mpm/cv", &mpm_Sample_desc, sample_reader_qos, sample_writer_qos, true},
    KnownTopic{"mpm/prediction", &mpm_Sample_desc, sample_reader_qos, sample_writer_qos, true},
    KnownTopic{"mpm/setpoint", &mpm_Sample_desc, sample_reader_qos, sample_writer_qos, true},
    KnownTopic{kLayoutTopic, &mpm_Layout_desc, late_joiner_reader_qos, layout_writer, false},
    KnownTopic{kChannelStatusTopic, &mpm_ChannelStatus_desc, channel_status_reader_qos,
               status_writer, false},
    KnownTopic{kAlarmTopic, &mpm_Alarm_desc, late_joiner_reader_qos, alarm_writer, false},
    KnownTopic{kAlarmEventTopic, &mpm_AlarmEvent_desc, alarm_event_reader_qos, event_writer, false},
    KnownTopic{kHealthTopic, &mpm_Health_desc, late_joiner_reader_qos, health_writer, false},
};

}  // namespace

std::span<const KnownTopic> known_topics() { return kTopics; }

const KnownTopic* find_known_topic(std::string_view name) {
  const auto found = std::find_if(kTopics.begin(), kTopics.end(),
                                  [name](const KnownTopic& topic) { return topic.name == name; });
  return found == kTopics.end() ? nullptr : &*found;
}

std::string_view idl_text() { return kIdlText; }

}  // namespace mpm::idl
