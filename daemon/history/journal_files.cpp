#include "daemon/history/journal_files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

namespace mpm::history {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kFilesKept = 16;
constexpr std::chrono::seconds kBetweenTries{10};  // to begin the first file
constexpr std::string_view kExtension = ".jsonl";
constexpr std::size_t kFewestDigits = 6, kMostDigits = 9;

bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

// A file that somebody removes takes what is written, and nobody will read it.
bool has_name(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

}  // namespace

bool parse_journal_name(std::string_view name, std::string& unit, int& number) {
  if (!name.ends_with(kExtension)) return false;
  name.remove_suffix(kExtension.size());
  const std::size_t dash = name.rfind('-');
  if (dash == std::string_view::npos || dash == 0) return false;
  const std::string_view digits = name.substr(dash + 1);
  if (digits.size() < kFewestDigits || digits.size() > kMostDigits) return false;
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (status != std::errc() || end != digits.data() + digits.size()) return false;
  unit = name.substr(0, dash);
  return true;
}

JournalFiles::JournalFiles(const std::string& folder, const std::string& unit,
                           std::uint64_t keep_bytes)
    : folder_(folder),
      unit_(unit),
      keep_bytes_(keep_bytes),
      file_bytes_(std::max<std::uint64_t>(1, keep_bytes / kFilesKept)) {
  begin();
}

// Of a folder that cannot be read, or not yet, nothing is known.
void JournalFiles::begin() {
  std::error_code error;
  fs::create_directory(folder_, error);
  std::error_code ignored;
  if (fs::exists(folder_, ignored) && !fs::is_directory(folder_, ignored))
    error = std::make_error_code(std::errc::not_a_directory);
  if (!error) error = find_earlier();
  if (error) {
    problem_ = folder_ + ": " + error.message();
    return;
  }
  if (!open_next()) {
    problem_ = path_of(number_ + 1) + ": " + std::generic_category().message(errno);
    return;
  }
  begun_ = true;
  problem_.clear();
  make_room();
}

JournalFiles::JournalFiles(JournalFiles&& other) noexcept
    : folder_(std::move(other.folder_)),
      unit_(std::move(other.unit_)),
      keep_bytes_(other.keep_bytes_),
      file_bytes_(other.file_bytes_),
      earlier_(std::move(other.earlier_)),
      begun_(other.begun_),
      number_(other.number_),
      descriptor_(std::exchange(other.descriptor_, -1)),
      bytes_(other.bytes_),
      problem_(std::move(other.problem_)) {}

JournalFiles::~JournalFiles() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::string JournalFiles::path_of(int number) const {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "-%06d", number);
  return (fs::path(folder_) / (unit_ + text.data() + std::string(kExtension))).string();
}

// Files of nothing, which a start without any samples leaves behind, go.
std::error_code JournalFiles::find_earlier() {
  std::error_code error;
  earlier_.clear();
  for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
    const fs::directory_entry& entry = *at;
    std::string unit;
    File file;
    std::error_code gone;  // somebody else may have been quicker
    if (!entry.is_regular_file(gone) ||
        !parse_journal_name(entry.path().filename().string(), unit, file.number) || unit != unit_)
      continue;
    file.bytes = entry.file_size(gone);
    if (gone || (file.bytes == 0 && fs::remove(entry.path(), gone))) continue;
    earlier_.push_back(file);
  }
  std::sort(earlier_.begin(), earlier_.end(),
            [](const File& a, const File& b) { return a.number < b.number; });
  if (!earlier_.empty()) number_ = earlier_.back().number;
  return error;
}

// Of none that is there: another daemon may have made some since.
bool JournalFiles::open_next() {
  do {
    ++number_;
    descriptor_ =
        open(path_of(number_).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ >= 0) return true;
  --number_;
  return false;
}

// For the file at hand and the text that makes it too long.
void JournalFiles::make_room() {
  std::uint64_t total = 2 * file_bytes_;
  for (const File& file : earlier_) total += file.bytes;
  while (total > keep_bytes_ && !earlier_.empty()) {
    std::error_code ignored;  // somebody else may have been quicker
    fs::remove(path_of(earlier_.front().number), ignored);
    total -= earlier_.front().bytes;
    earlier_.pop_front();
  }
}

void JournalFiles::turn_over() {
  if (!begun_) {
    if (Clock::now() < next_try_) return;
    next_try_ = Clock::now() + kBetweenTries;
    return begin();
  }
  const bool there = has_name(descriptor_);
  if (there && bytes_ < file_bytes_) return;
  if (!there) {
    std::error_code ignored;  // then there is no file either
    fs::create_directory(folder_, ignored);
  }
  const int full = std::exchange(descriptor_, -1);
  const File file{number_, bytes_};
  if (!open_next()) {
    if (!there) problem_ = std::generic_category().message(errno);
    descriptor_ = full;  // goes on growing
    return;
  }
  close(full);
  if (there) earlier_.push_back(file);
  bytes_ = 0;
  make_room();
}

bool JournalFiles::append(std::string_view text) {
  if (!begun_) return false;
  if (!has_name(descriptor_)) {
    if (problem_.empty()) problem_ = std::generic_category().message(ENOENT);
    return false;
  }
  if (write_all(descriptor_, text)) {
    bytes_ += text.size();
    problem_.clear();
    return true;
  }
  problem_ = std::generic_category().message(errno);
  // What the disk still took of it.
  if (ftruncate(descriptor_, static_cast<off_t>(bytes_)) != 0) problem_ += ", nor cut";
  return false;
}

}  // namespace mpm::history
