#include "daemon/bag/replay/mcap_source.hpp"

#include <algorithm>
#include <limits>

#include "config/finding.hpp"
#include "daemon/bag/refuse.hpp"

namespace mpm::bag {
namespace {

constexpr std::string_view kSuffix = kLifecycleSuffix;

bool is_lifecycle(const std::string& topic) {
  return topic.size() > kSuffix.size() &&
         topic.compare(topic.size() - kSuffix.size(), kSuffix.size(), kSuffix) == 0;
}

std::string base_topic(const std::string& topic) {
  return is_lifecycle(topic) ? topic.substr(0, topic.size() - kSuffix.size()) : topic;
}

}  // namespace

McapSource::McapSource(const std::vector<std::string>& files, const std::set<std::string>& topics)
    : topics_(topics), messages_(files) {
  begin_ns_ = std::numeric_limits<std::int64_t>::max();
  end_ns_ = std::numeric_limits<std::int64_t>::min();
  for (const mcap::FileSequence::File& file : messages_.files()) {
    begin_ns_ = std::min(begin_ns_, file.start_ns);
    end_ns_ = std::max(end_ns_, file.end_ns);
    end_known_ = end_known_ && file.end_known;
    for (const std::string& topic : file.topics)
      if (topics_.count(topic) > 0) found_.insert(topic);
  }
  if (!found_.empty()) return;
  std::string wanted;
  for (const std::string& topic : topics) wanted += (wanted.empty() ? "" : ", ") + topic;
  refuse(files.empty() ? "" : files.front(), "holds no sample of " + wanted);
}

bool McapSource::wanted(const mcap::Message& message) const {
  const std::string& topic = message.channel->topic;
  if (topics_.count(base_topic(topic)) == 0) return false;
  return message.channel->message_encoding == (is_lifecycle(topic) ? "json" : "cdr");
}

bool McapSource::next(ReplaySample& sample) {
  mcap::Message message;
  do {
    if (!messages_.next(message)) return false;
  } while (!wanted(message));
  fill(message, sample);
  return true;
}

void McapSource::fill(const mcap::Message& message, ReplaySample& sample) {
  sample.topic = base_topic(message.channel->topic);
  sample.log_time_ns = message.log_time_ns;
  sample.source_time_ns = message.publish_time_ns;
  if (!is_lifecycle(message.channel->topic)) {
    sample.state = idl::InstanceState::kAlive;
    sample.cdr = message.data;
    return;
  }
  std::optional<Lifecycle> end =
      parse_lifecycle({reinterpret_cast<const char*>(message.data.data()), message.data.size()});
  if (!end) refuse(file(), "a message of " + message.channel->topic + " is not as it should be");
  lifecycle_ = std::move(*end);
  sample.state = lifecycle_.state;
  sample.cdr = lifecycle_.key;
}

}  // namespace mpm::bag
