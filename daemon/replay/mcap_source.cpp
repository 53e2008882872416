#include "daemon/replay/mcap_source.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "config/finding.hpp"

namespace mpm::daemon {
namespace {

constexpr std::string_view kSuffix = kLifecycleSuffix;

bool is_lifecycle(const std::string& topic) {
  return topic.size() > kSuffix.size() &&
         topic.compare(topic.size() - kSuffix.size(), kSuffix.size(), kSuffix) == 0;
}

std::string base_topic(const std::string& topic) {
  return is_lifecycle(topic) ? topic.substr(0, topic.size() - kSuffix.size()) : topic;
}

[[noreturn]] void refuse(const std::string& path, const std::string& message) {
  throw config::InputError({path, 0, 0, config::Severity::kError, "", message});
}

}  // namespace

std::vector<std::string> recording_files(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(path))
    if (entry.path().extension() == ".mcap") files.push_back(entry.path().string());
  if (files.empty()) refuse(path, "no *.mcap file in this folder");
  std::sort(files.begin(), files.end());
  return files;
}

McapSource::McapSource(const std::vector<std::string>& files, const std::set<std::string>& topics)
    : topics_(topics) {
  begin_ns_ = std::numeric_limits<std::int64_t>::max();
  end_ns_ = std::numeric_limits<std::int64_t>::min();
  for (const std::string& file : files) look_at(file);
  if (files_.empty() || found_.empty()) {
    std::string wanted;
    for (const std::string& topic : topics) wanted += (wanted.empty() ? "" : ", ") + topic;
    refuse(files.empty() ? "" : files.front(), "holds no sample of " + wanted);
  }
  std::stable_sort(files_.begin(), files_.end(),
                   [](const File& a, const File& b) { return a.start_ns < b.start_ns; });
}

// The first message tells what the file is about: of a recording of ours all definitions precede it
// or stand in the summary.
void McapSource::look_at(const std::string& path) {
  const std::unique_ptr<mcap::MessageSource> messages = mcap::open_messages(path);
  mcap::Message first;
  if (!messages->next(first)) return;
  files_.push_back({path, first.log_time_ns});
  for (const auto& [id, channel] : messages->definitions().channels())
    if (topics_.count(base_topic(channel.topic)) > 0 && !is_lifecycle(channel.topic))
      found_.insert(channel.topic);
  mcap::InputFile file(path);
  begin_ns_ = std::min(begin_ns_, first.log_time_ns);
  end_ns_ = std::max(end_ns_, first.log_time_ns);
  const mcap::FileLayout layout = mcap::scan(file);
  end_known_ = end_known_ && !layout.messages_outside;  // heads tell no time of those
  for (const mcap::ChunkPlace& chunk : layout.chunks)
    end_ns_ = std::max(end_ns_, static_cast<std::int64_t>(chunk.end_ns));
}

void McapSource::rewind() {
  open_.clear();
  next_file_ = 0;
  given_.reset();
}

bool McapSource::wanted(const mcap::Message& message) const {
  const std::string& topic = message.channel->topic;
  if (topics_.count(base_topic(topic)) == 0) return false;
  return message.channel->message_encoding == (is_lifecycle(topic) ? "json" : "cdr");
}

bool McapSource::advance(Open& open) const {
  while (open.messages->next(open.head))
    if (wanted(open.head)) return true;
  return false;
}

// Files that follow each other are open one at a time.
void McapSource::open_files_up_to_head() {
  const auto head_ns = [this] {
    std::int64_t earliest = std::numeric_limits<std::int64_t>::max();
    for (const Open& open : open_) earliest = std::min(earliest, open.head.log_time_ns);
    return earliest;
  };
  while (next_file_ < files_.size() &&
         (open_.empty() || files_[next_file_].start_ns <= head_ns())) {
    Open open{next_file_, mcap::open_messages(files_[next_file_].path), {}};
    ++next_file_;
    if (advance(open)) open_.push_back(std::move(open));
  }
}

bool McapSource::next(ReplaySample& sample) {
  while (true) {
    if (given_) {
      if (!advance(open_[*given_]))
        open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(*given_));
      given_.reset();
    }
    open_files_up_to_head();
    if (open_.empty()) return false;
    const auto first = std::min_element(
        open_.begin(), open_.end(),
        [](const Open& a, const Open& b) { return a.head.log_time_ns < b.head.log_time_ns; });
    given_ = static_cast<std::size_t>(first - open_.begin());
    last_file_ = first->file;
    if (fill(first->head, sample)) return true;
  }
}

bool McapSource::fill(const mcap::Message& message, ReplaySample& sample) {
  sample.topic = base_topic(message.channel->topic);
  sample.log_time_ns = message.log_time_ns;
  sample.source_time_ns = message.publish_time_ns;
  if (!is_lifecycle(message.channel->topic)) {
    sample.state = idl::InstanceState::kAlive;
    sample.cdr = message.data;
    return true;
  }
  std::optional<Lifecycle> end =
      parse_lifecycle({reinterpret_cast<const char*>(message.data.data()), message.data.size()});
  if (!end) refuse(file(), "a message of " + message.channel->topic + " is not as it should be");
  lifecycle_ = std::move(*end);
  sample.state = lifecycle_.state;
  sample.cdr = lifecycle_.key;
  return true;
}

const std::string& McapSource::file() const { return files_[last_file_].path; }

}  // namespace mpm::daemon
