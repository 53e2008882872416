#include "idl/topic_catalog.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>

#include "idl/topics.hpp"

namespace mpm::idl {

extern const std::string_view kIdlText;  // written by embed.cmake

namespace {

template <class Sample>
constexpr KnownTopic known(const char* name, Qos (*reader_qos)(), Qos (*writer_qos)(WriterPace),
                           bool input = false) {
  static_assert(offsetof(Sample, unit) == 0);
  return {name, TopicType<Sample>::descriptor(), reader_qos, writer_qos, input};
}

constexpr KnownTopic input(const char* name) {
  return known<mpm_Sample>(name, sample_reader_qos, sample_writer_qos, true);
}

Qos no_writer(WriterPace) { return role_reader_qos(); }
Qos layout_writer(WriterPace) { return layout_qos(); }
Qos command_writer(WriterPace) { return command_qos(); }

template <class Record>
Qos output_writer(WriterPace) {
  return OutputTopic<Record>::kWriterQos();
}

// One reader sees all that a late joiner may see and all that comes while it is busy.
template <class... Record>
constexpr auto topics(const std::tuple<Record...>*) {
  return std::array{
      input("mpm/mv"),
      input("mpm/dv"),
      input("mpm/cv"),
      input("mpm/prediction"),
      input("mpm/setpoint"),
      input("mpm/raw"),
      known<mpm_Layout>(kLayoutTopic, late_joiner_reader_qos, layout_writer),
      known<mpm_Command>(kCommandTopic, command_qos, command_writer),
      known<mpm_CommandReply>(kCommandReplyTopic, command_qos, command_writer),
      known<SampleOf<Record>>(OutputTopic<Record>::kName, OutputTopic<Record>::kEveryChangeQos,
                              output_writer<Record>)...};
}

constexpr KnownTopic kRole = known<mpm_Role>(kRoleTopic, role_reader_qos, no_writer);
constexpr std::array kTopics = topics(static_cast<const OutputRecords*>(nullptr));

}  // namespace

std::span<const KnownTopic> known_topics() { return kTopics; }

const KnownTopic& role_topic() { return kRole; }

const KnownTopic* find_known_topic(std::string_view name) {
  const auto found = std::find_if(kTopics.begin(), kTopics.end(),
                                  [name](const KnownTopic& topic) { return topic.name == name; });
  return found == kTopics.end() ? nullptr : &*found;
}

std::string_view idl_text() { return kIdlText; }

}  // namespace mpm::idl
