#include "daemon/record/recording_files.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace mpm::daemon {
namespace {

constexpr std::string_view kExtension = ".mcap";

std::string time_name(std::int64_t time_ns) {
  const auto seconds = static_cast<std::time_t>(time_ns / 1'000'000'000);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "mpm-%Y%m%dT%H%M%SZ", &utc);
  return text.data();
}

// mpm-YYYYMMDDThhmmssZ-NNNN.mcap, more digits at the end allowed.
bool is_ours(const std::string& name) {
  static constexpr std::string_view kShape = "mpm-ddddddddTddddddZ-dddd";
  if (name.size() < kShape.size() + kExtension.size() ||
      name.substr(name.size() - kExtension.size()) != kExtension)
    return false;
  const std::string stem = name.substr(0, name.size() - kExtension.size());
  for (std::size_t i = 0; i < stem.size(); ++i) {
    const bool digit = stem[i] >= '0' && stem[i] <= '9';
    if (i >= kShape.size() || kShape[i] == 'd' ? !digit : stem[i] != kShape[i]) return false;
  }
  return true;
}

}  // namespace

RecordingFiles::RecordingFiles(const std::string& output, bool split, std::uint64_t quota_bytes,
                               std::int64_t start_ns)
    : quota_bytes_(quota_bytes) {
  const std::filesystem::path path(output);
  const bool is_folder = path.extension() != kExtension || std::filesystem::is_directory(path);
  numbered_ = is_folder || split;
  folder_ = is_folder ? path : path.parent_path();
  stem_ = is_folder ? time_name(start_ns) : path.stem().string();
  if (!folder_.empty()) std::filesystem::create_directories(folder_);
  if (is_folder) find_earlier();
}

void RecordingFiles::find_earlier() {
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    if (entry.is_regular_file() && is_ours(entry.path().filename().string()))
      files_.push_back({entry.path(), entry.file_size()});
  std::sort(files_.begin(), files_.end(),  // by time, then number
            [](const File& a, const File& b) { return a.path < b.path; });
}

std::string RecordingFiles::next() {
  std::array<char, 16> number{};
  std::snprintf(number.data(), number.size(), "-%04d", ++number_);
  const std::filesystem::path path =
      folder_ / (stem_ + (numbered_ ? number.data() : "") + std::string(kExtension));
  if (std::filesystem::exists(path))
    throw std::invalid_argument(path.string() + ": there is such a file already");
  return path.string();
}

void RecordingFiles::finished(const std::string& path, std::uint64_t bytes) {
  files_.push_back({path, bytes});
}

void RecordingFiles::make_room(std::uint64_t room) {
  if (quota_bytes_ == 0) return;
  std::uint64_t total = room;
  for (const File& file : files_) total += file.bytes;
  while (total > quota_bytes_ && files_.size() > 1) {
    std::error_code ignored;  // somebody else may have been quicker
    if (std::filesystem::remove(files_.front().path, ignored)) ++deleted_;
    total -= files_.front().bytes;
    files_.pop_front();
  }
}

}  // namespace mpm::daemon
