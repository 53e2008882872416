#include "daemon/mcap/read/file_sequence.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "config/finding.hpp"
#include "daemon/mcap/read/record_stream.hpp"

namespace mpm::mcap {

bool is_recording(const std::string& path) {
  return std::filesystem::is_directory(path) || is_mcap(path) || path.ends_with(".mcap");
}

bool is_recording(const std::vector<std::string>& paths) {
  const auto other = std::find_if_not(paths.begin(), paths.end(),
                                      [](const auto& path) { return is_recording(path); });
  if (other == paths.end()) return true;
  if (paths.size() == 1) return false;
  throw config::InputError({*other, 0, 0, config::Severity::kError, "",
                            "is no MCAP file; only those are taken together"});
}

std::vector<std::string> recording_files(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(path))
    if (entry.path().extension() == ".mcap") files.push_back(entry.path().string());
  if (files.empty())
    throw config::InputError(
        {path, 0, 0, config::Severity::kError, "", "no *.mcap file in this folder"});
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> recording_files(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths)
    for (std::string& file : recording_files(path)) files.push_back(std::move(file));
  return files;
}

std::string name_of(const std::vector<std::string>& paths) {
  if (paths.empty()) return {};
  if (paths.size() == 1) return paths.front();
  return paths.front() + " and " + std::to_string(paths.size() - 1) + " more";
}

FileSequence::FileSequence(const std::vector<std::string>& paths) {
  for (const std::string& path : recording_files(paths)) look_at(path);
  std::stable_sort(files_.begin(), files_.end(),
                   [](const File& a, const File& b) { return a.start_ns < b.start_ns; });
}

// The first message tells what the file is about: of a recording of ours all definitions precede it
// or stand in the summary.
void FileSequence::look_at(const std::string& path) {
  const std::unique_ptr<MessageSource> messages = open_messages(path);
  Message first;
  if (!messages->next(first)) return;
  File file{path, first.log_time_ns, first.log_time_ns, true, {}};
  for (const auto& [id, channel] : messages->definitions().channels())
    file.topics.insert(channel.topic);
  InputFile input(path);
  const FileLayout layout = scan(input);
  file.end_known = !layout.messages_outside;
  for (const ChunkPlace& chunk : layout.chunks)
    file.end_ns = std::max(file.end_ns, static_cast<std::int64_t>(chunk.end_ns));
  files_.push_back(std::move(file));
}

void FileSequence::rewind() {
  open_.clear();
  next_file_ = 0;
  given_.reset();
}

void FileSequence::open_files_up_to_head() {
  const auto head_ns = [this] {
    std::int64_t earliest = std::numeric_limits<std::int64_t>::max();
    for (const Open& open : open_) earliest = std::min(earliest, open.head.log_time_ns);
    return earliest;
  };
  while (next_file_ < files_.size() &&
         (open_.empty() || files_[next_file_].start_ns <= head_ns())) {
    Open open{next_file_, open_messages(files_[next_file_].path), {}};
    ++next_file_;
    if (open.messages->next(open.head)) open_.push_back(std::move(open));
  }
}

bool FileSequence::next(Message& message) {
  if (given_) {
    Open& open = open_[*given_];
    if (!open.messages->next(open.head))
      open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(*given_));
    given_.reset();
  }
  open_files_up_to_head();
  if (open_.empty()) return false;
  const auto first = std::min_element(open_.begin(), open_.end(), [](const Open& a, const Open& b) {
    return a.head.log_time_ns < b.head.log_time_ns;
  });
  given_ = static_cast<std::size_t>(first - open_.begin());
  last_file_ = first->file;
  message = first->head;
  return true;
}

}  // namespace mpm::mcap
