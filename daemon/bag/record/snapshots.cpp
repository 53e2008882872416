#include "daemon/bag/record/snapshots.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <regex>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "config/replacement_file.hpp"
#include "core/record/alarm_record.hpp"
#include "core/text/number_text.hpp"
#include "daemon/files/folder_name.hpp"
#include "daemon/files/times/time_text.hpp"
#include "daemon/mcap/recover.hpp"
#include "idl/cdr.hpp"

namespace mpm::bag {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestPart = 64;  // of three, in a name of 255

std::string part(const char* name) {
  return files::folder_name(name == nullptr ? "" : name).substr(0, kLongestPart);
}

std::string utc(std::int64_t time_ns) {
  return files::formatted_utc(time_ns / 1'000'000'000, "%Y-%m-%dT%H:%M:%SZ");
}

/// What the files in there take; those that several snapshots share count once.
std::uint64_t bytes_in(const fs::path& folder) {
  std::set<std::pair<dev_t, ino_t>> seen;
  std::uint64_t bytes = 0;
  std::error_code ignored;  // somebody may be deleting some
  for (fs::recursive_directory_iterator entry(folder, ignored), end; entry != end;
       entry.increment(ignored)) {
    struct stat file {};
    if (stat(entry->path().c_str(), &file) != 0 || !S_ISREG(file.st_mode)) continue;
    if (seen.emplace(file.st_dev, file.st_ino).second)
      bytes += static_cast<std::uint64_t>(file.st_size);
  }
  return bytes;
}

/// Those that are named as ours are.
std::vector<fs::path> snapshots_by_age(const fs::path& folder) {
  static const std::regex ours(".*-[0-9]{8,}T[0-9]{6}([.][0-9]{3})?Z");
  std::vector<std::pair<fs::file_time_type, fs::path>> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.is_directory() && std::regex_match(entry.path().filename().string(), ours))
      found.emplace_back(entry.last_write_time(ignored), entry.path());
  std::sort(found.begin(), found.end());
  std::vector<fs::path> paths;
  paths.reserve(found.size());
  for (auto& [time, path] : found) paths.push_back(std::move(path));
  return paths;
}

}  // namespace

std::optional<std::string> alarm_snapshot(std::span<const std::byte> cdr) {
  idl::CdrDecoder<mpm_AlarmEvent> decoder;
  const mpm_AlarmEvent* event = decoder.decode(cdr);
  if (event == nullptr || event->to == nullptr ||
      std::string_view(event->to) != to_string(AlarmChange::kActive))
    return std::nullopt;
  return part(event->unit) + '-' + part(event->mv) + '-' + part(event->cv) + '-' +
         files::time_folder(event->source_time_ns);
}

std::string hand_snapshot(std::int64_t now_ns) { return "by-hand-" + files::time_folder(now_ns); }

Snapshots::Snapshots(const fs::path& folder, const SnapshotOptions& options)
    : folder_(folder / "saved"), options_(options) {}

void Snapshots::check(const fs::path& file) const {
  std::error_code error;
  fs::create_directories(folder_, error);
  const fs::path probe = folder_ / ".probe";
  if (!error) {
    std::error_code ignored;
    fs::remove(probe, ignored);
    fs::create_hard_link(file, probe, error);
    fs::remove(probe, ignored);
  }
  if (error)
    throw std::invalid_argument(folder_.string() + ": no file can have a second name here (" +
                                error.message() + "), which snapshots are made of");
}

void Snapshots::begin(const std::string& name, std::int64_t time_ns, std::int64_t after_ns,
                      std::int64_t now_ns, const std::deque<RecordingFiles::File>& complete) {
  time_ns = std::min(time_ns, now_ns);
  Open snapshot{folder_ / name, time_ns + after_ns, 0, 0, 0};
  const auto same = [&](const Open& other) { return other.folder == snapshot.folder; };
  if (snapshot.end_ns < now_ns || std::any_of(open_.begin(), open_.end(), same)) return;
  if (!has_room(name)) return;
  std::error_code error;
  fs::create_directories(snapshot.folder, error);
  if (error) {
    news_.push_back(snapshot.folder.string() + " cannot be made: " + error.message());
    return;
  }
  news_.push_back("saving " + snapshot.folder.string() + " until " + utc(snapshot.end_ns));
  for (const RecordingFiles::File& file : complete)
    if (file.end_ns >= time_ns - options_.before_ns) save(file, snapshot);
  open_.push_back(std::move(snapshot));
}

bool Snapshots::has_room(const std::string& name) {
  if (options_.quota_bytes == 0) return true;
  std::vector<fs::path> oldest = snapshots_by_age(folder_);
  const auto open = [this](const fs::path& folder) {
    return std::any_of(open_.begin(), open_.end(),
                       [&](const Open& snapshot) { return snapshot.folder == folder; });
  };
  while (bytes_in(folder_) >= options_.quota_bytes) {
    const auto victim = std::find_if_not(oldest.begin(), oldest.end(), open);
    if (!options_.drop_oldest || victim == oldest.end()) {
      news_.push_back(name + " is not saved: what lies in " + folder_.string() +
                      " takes all that it may");
      return false;
    }
    news_.push_back("deleting " + victim->string() + " to make room for " + name);
    std::error_code ignored;
    fs::remove_all(*victim, ignored);
    oldest.erase(victim);
  }
  return true;
}

bool Snapshots::due(std::int64_t now_ns) const {
  return std::any_of(open_.begin(), open_.end(),
                     [&](const Open& snapshot) { return now_ns >= snapshot.end_ns; });
}

void Snapshots::save(const RecordingFiles::File& file, Open& snapshot) {
  const fs::path to = snapshot.folder / file.path.filename();
  try {
    if (fs::exists(to)) {  // of the same snapshot before a restart
    } else if (file.whole) {
      fs::create_hard_link(file.path, to);
    } else {
      config::ReplacementFile mended(to.string());
      static_cast<void>(
          mcap::recover(file.path.string(), {mended.temporary(), mended.descriptor()}));
      mended.commit();
    }
  } catch (const std::exception& error) {
    news_.push_back(file.path.string() + " could not be saved: " + error.what());
    return;
  }
  if (snapshot.files++ == 0) snapshot.first_ns = file.start_ns;
  snapshot.last_ns = file.end_ns;
}

void Snapshots::add(const RecordingFiles::File& file, std::int64_t now_ns) {
  for (Open& snapshot : open_) save(file, snapshot);
  const auto over = std::stable_partition(
      open_.begin(), open_.end(), [&](const Open& snapshot) { return now_ns < snapshot.end_ns; });
  for (auto snapshot = over; snapshot != open_.end(); ++snapshot) tell_saved(*snapshot, "saved ");
  open_.erase(over, open_.end());
}

void Snapshots::finish() {
  for (const Open& snapshot : open_) tell_saved(snapshot, "saved as far as it goes ");
  open_.clear();
}

void Snapshots::tell_saved(const Open& snapshot, const std::string& how) {
  std::string text = how + snapshot.folder.string() + ": " + counted(snapshot.files, "file");
  if (snapshot.files > 0)
    text += ", from " + utc(snapshot.first_ns) + " to " + utc(snapshot.last_ns);
  news_.push_back(std::move(text));
}

std::vector<std::string> Snapshots::take_news() { return std::exchange(news_, {}); }

}  // namespace mpm::bag
