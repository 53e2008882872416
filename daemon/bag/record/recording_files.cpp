#include "daemon/bag/record/recording_files.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include "config/finding.hpp"
#include "daemon/bag/split_name.hpp"
#include "daemon/files/times/time_text.hpp"
#include "daemon/mcap/read/scan.hpp"

namespace mpm::bag {
namespace {

// A recorder that keeps the last hours only must not take what others have kept for its own.
std::string prefix_of(std::int64_t keep_ns) { return keep_ns > 0 ? "ring-" : "mpm-"; }

std::string time_name(const std::string& prefix, std::int64_t time_ns) {
  return prefix + files::formatted_utc(time_ns / 1'000'000'000, "%Y%m%dT%H%M%SZ");
}

// mpm-YYYYMMDDThhmmssZ
bool is_time_name(std::string_view stem, const std::string& prefix) {
  static constexpr std::string_view kShape = "ddddddddTddddddZ";
  if (!stem.starts_with(prefix)) return false;
  stem.remove_prefix(prefix.size());
  return std::equal(stem.begin(), stem.end(), kShape.begin(), kShape.end(), [](char c, char shape) {
    return shape == 'd' ? c >= '0' && c <= '9' : c == shape;
  });
}

// What the heads of its chunks tell: nothing is unpacked.
void look_into(RecordingFiles::File& file) {
  try {
    mcap::InputFile input(file.path.string());
    const mcap::FileLayout layout = mcap::scan(input);
    file.whole = !layout.damage;
    if (layout.chunks.empty()) return;
    file.start_ns = static_cast<std::int64_t>(layout.chunks.front().start_ns);
    file.end_ns = 0;
    for (const mcap::ChunkPlace& chunk : layout.chunks)
      file.end_ns = std::max(file.end_ns, static_cast<std::int64_t>(chunk.end_ns));
  } catch (const config::InputError&) {  // no recording, in spite of its name
    file.whole = false;
  }
}

// A link counts, wherever it leads.
bool is_there(const std::filesystem::path& path) {
  return std::filesystem::exists(std::filesystem::symlink_status(path));
}

}  // namespace

RecordingFiles::RecordingFiles(const std::string& output, bool split, std::uint64_t quota_bytes,
                               std::int64_t start_ns, std::int64_t keep_ns)
    : quota_bytes_(quota_bytes), keep_ns_(keep_ns) {
  const std::filesystem::path path(output);
  const bool is_folder = path.extension() != kExtension || std::filesystem::is_directory(path);
  numbered_ = is_folder || split;
  folder_ = is_folder ? path : path.parent_path();
  stem_ = is_folder ? time_name(prefix_of(keep_ns_), start_ns) : path.stem().string();
  std::error_code error;
  if (!folder_.empty()) std::filesystem::create_directories(folder_, error);
  if (error)
    throw std::runtime_error(folder_.string() +
                             ": a folder of that name cannot be made: " + error.message());
  if (numbered_) find_earlier(is_folder, start_ns);
}

void RecordingFiles::find_earlier(bool of_any_time, std::int64_t start_ns) {
  struct Earlier {
    SplitName name;
    File file;
  };
  std::vector<Earlier> earlier;
  const std::filesystem::path here = folder_.empty() ? "." : folder_;
  for (const auto& entry : std::filesystem::directory_iterator(here)) {
    if (!entry.is_regular_file()) continue;
    std::optional<SplitName> name = split_name(entry.path().filename().string());
    if (!name ||
        (name->stem != stem_ && !(of_any_time && is_time_name(name->stem, prefix_of(keep_ns_)))))
      continue;
    if (name->stem == stem_) number_ = std::max(number_, name->number);
    earlier.push_back(
        {std::move(*name), {entry.path(), entry.file_size(), start_ns, start_ns, true}});
  }
  std::sort(earlier.begin(), earlier.end(), [](const Earlier& a, const Earlier& b) {
    return std::tie(a.name.stem, a.name.number) < std::tie(b.name.stem, b.name.number);
  });
  for (Earlier& file : earlier) {
    if (keep_ns_ > 0) look_into(file.file);
    files_.push_back(std::move(file.file));
  }
}

std::string RecordingFiles::next() {
  std::filesystem::path path = folder_ / (stem_ + std::string(kExtension));
  if (!numbered_) {
    if (is_there(path))
      throw std::invalid_argument(path.string() + ": there is such a file already");
    return path.string();
  }
  do {  // another recorder may have made some since
    std::array<char, 16> number{};
    std::snprintf(number.data(), number.size(), "-%04d", ++number_);
    path = folder_ / (stem_ + number.data() + std::string(kExtension));
  } while (is_there(path));
  return path.string();
}

void RecordingFiles::finished(File file) { files_.push_back(std::move(file)); }

void RecordingFiles::make_room(std::uint64_t room, std::int64_t now_ns) {
  std::uint64_t total = room;
  for (const File& file : files_) total += file.bytes;
  const auto has_to_go = [&](const File& file) {
    return (quota_bytes_ > 0 && total > quota_bytes_) ||
           (keep_ns_ > 0 && file.end_ns < now_ns - keep_ns_);
  };
  while (files_.size() > 1 && has_to_go(files_.front())) {
    std::error_code ignored;  // somebody else may have been quicker
    if (std::filesystem::remove(files_.front().path, ignored)) ++deleted_;
    total -= files_.front().bytes;
    files_.pop_front();
  }
}

}  // namespace mpm::bag
