#include "daemon/bag/list.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>

#include "config/finding.hpp"
#include "daemon/bag/contents.hpp"
#include "daemon/bag/split_name.hpp"
#include "daemon/mcap/read/file_sequence.hpp"
#include "daemon/mcap/read/reader.hpp"
#include "daemon/mcap/read/scan.hpp"
#include "idl/raw_sample.hpp"
#include "idl/topic_catalog.hpp"

namespace mpm::bag {
namespace {

namespace fs = std::filesystem;

void add_unit(const mcap::Message& message, ListedRecording& recording) {
  if (message.channel->message_encoding != "cdr" || recording.units.size() >= kMostUnits ||
      idl::find_known_topic(message.channel->topic) == nullptr)
    return;
  if (std::string unit = idl::unit_of(message.data); !unit.empty())
    recording.units.insert(std::move(unit));
}

void widen(std::int64_t start_ns, std::int64_t end_ns, ListedRecording& recording) {
  recording.start_ns = std::min(recording.start_ns.value_or(start_ns), start_ns);
  recording.end_ns = std::max(recording.end_ns.value_or(end_ns), end_ns);
}

void read_chunk(const std::string& path, const mcap::ChunkPlace& chunk,
                ListedRecording& recording) {
  const auto messages = mcap::open_messages(path, {static_cast<std::int64_t>(chunk.start_ns),
                                                   static_cast<std::int64_t>(chunk.end_ns) + 1});
  mcap::Message message;
  while (messages->next(message)) add_unit(message, recording);
}

void read_all(const std::string& path, ListedRecording& recording) {
  mcap::Reader reader(path);
  mcap::Message message;
  while (reader.next(message)) {
    widen(message.log_time_ns, message.log_time_ns, recording);
    add_unit(message, recording);
    ++recording.messages;
  }
}

void look_into(const std::string& path, ListedRecording& recording) {
  try {
    mcap::InputFile file(path);
    const mcap::FileLayout layout = mcap::scan(file);
    if (layout.damage || layout.messages_outside || !layout.messages)
      return read_all(path, recording);
    recording.messages += *layout.messages;
    for (const mcap::ChunkPlace& chunk : layout.chunks)
      widen(static_cast<std::int64_t>(chunk.start_ns), static_cast<std::int64_t>(chunk.end_ns),
            recording);
    if (layout.chunks.empty()) return;
    read_chunk(path, layout.chunks.front(), recording);
    read_chunk(path, layout.chunks.back(), recording);
  } catch (const config::InputError& error) {
    if (recording.problem.empty()) recording.problem = error.what();
  }
}

void add_file(const fs::directory_entry& entry, ListedRecording& recording) {
  std::error_code ignored;  // a recorder may delete some meanwhile
  recording.bytes += entry.file_size(ignored);
  recording.files.push_back(entry.path().string());
}

}  // namespace

std::vector<ListedRecording> list_recordings(const std::string& folder) {
  if (!fs::is_directory(folder))
    throw config::InputError({folder, 0, 0, config::Severity::kError, "", "is no folder"});
  std::map<std::string, ListedRecording> by_name;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory()) {
      for (const auto& inner : fs::directory_iterator(entry))
        if (inner.path().extension() == kExtension) add_file(inner, by_name[name + '/']);
    } else if (const std::optional<SplitName> split = split_name(name)) {
      add_file(entry, by_name[split->stem + "-*" + std::string(kExtension)]);
    } else if (name.ends_with(kExtension)) {
      add_file(entry, by_name[name]);
    }
  }
  std::vector<ListedRecording> list;
  for (auto& [name, recording] : by_name) {
    recording.name = name;
    std::sort(recording.files.begin(), recording.files.end());
    for (const std::string& file : recording.files) look_into(file, recording);
    list.push_back(std::move(recording));
  }
  std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) {
    return a.start_ns < b.start_ns;  // those without a message first
  });
  return list;
}

}  // namespace mpm::bag
