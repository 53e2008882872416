#include "daemon/live/sample_log.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "config/failure_text.hpp"
#include "config/whole_file.hpp"
#include "core/text/number_text.hpp"
#include "daemon/live/numbered_files.hpp"

namespace mpm::live {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "mpm samples 1\n";
constexpr std::string_view kPrefix = "samples-";
// A record of its own, and not an empty one: that is what a file looks like whose end a power cut
// has left as zeros.
constexpr std::string_view kExpiry = "x";

// On disk as in memory: nothing is ever carried to another machine.
template <class Number>
void put(std::string& to, Number value) {
  std::array<char, sizeof value> bytes{};
  std::memcpy(bytes.data(), &value, sizeof value);
  to.append(bytes.data(), bytes.size());
}

/// Takes numbers from the front of a record; nothing where it is too short.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : bytes_(bytes) {}
  template <class Number>
  [[nodiscard]] std::optional<Number> take() {
    Number value{};
    if (bytes_.size() < sizeof value) return std::nullopt;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }
  [[nodiscard]] std::string_view rest() const { return bytes_; }

 private:
  std::string_view bytes_;
};

std::uint32_t sum_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      ::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

struct Block {
  BlockView view;
  std::vector<double> values;
  std::vector<std::uint8_t> quality;
};

void encode(const BlockView& block, std::string& to) {
  put(to, static_cast<std::uint8_t>(block.kind));
  put(to, block.interval);
  put(to, block.source_time_ns);
  put(to, static_cast<std::uint32_t>(block.values.size()));
  put(to, static_cast<std::uint32_t>(block.quality.size()));
  for (const double value : block.values) put(to, value);
  to.append(reinterpret_cast<const char*>(block.quality.data()), block.quality.size());
}

bool decode(std::string_view record, Block& block) {
  Cursor cursor(record);
  const auto kind = cursor.take<std::uint8_t>();
  const auto interval = cursor.take<std::int64_t>();
  const auto time = cursor.take<std::int64_t>();
  const auto values = cursor.take<std::uint32_t>();
  const auto qualities = cursor.take<std::uint32_t>();
  if (!qualities || *kind >= kSignalKindCount ||
      cursor.rest().size() != std::size_t{*values} * sizeof(double) + *qualities)
    return false;
  block.values.resize(*values);
  if (*values > 0)
    std::memcpy(block.values.data(), cursor.rest().data(), block.values.size() * sizeof(double));
  const std::string_view codes = cursor.rest().substr(block.values.size() * sizeof(double));
  block.quality.assign(codes.begin(), codes.end());
  block.view = {static_cast<SignalKind>(*kind), *interval, *time, block.values, block.quality};
  return true;
}

/// The next record of a file; nothing at its end, or where it was torn or damaged.
std::optional<std::string_view> next_record(std::string_view& bytes) {
  Cursor cursor(bytes);
  const auto size = cursor.take<std::uint32_t>();
  const auto sum = cursor.take<std::uint32_t>();
  if (!sum || *size == 0 || cursor.rest().size() < *size) return std::nullopt;
  const std::string_view record = cursor.rest().substr(0, *size);
  if (sum_of(record) != *sum) return std::nullopt;
  bytes = cursor.rest().substr(*size);
  return record;
}

// A file, or the names in a folder. Where it fails nobody could do better. What somebody has put
// there as a pipe is not waited for.
void sync_path(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return;
  static_cast<void>(::fsync(descriptor));
  ::close(descriptor);
}

}  // namespace

SampleLog::SampleLog(std::string folder, std::string meaning, std::uint64_t keep)
    : folder_(std::move(folder)), meaning_(std::move(meaning)), keep_(keep) {}

SampleLog::~SampleLog() { close_file(); }

std::string SampleLog::path_of(std::uint64_t number) const {
  return numbered_path(folder_, kPrefix, number);
}

void SampleLog::sync(const std::string& folder) {
  for (const std::uint64_t number : numbers_in(folder, kPrefix))
    sync_path(numbered_path(folder, kPrefix, number));
  sync_path(folder);
}

std::vector<std::uint64_t> SampleLog::files() const { return numbers_in(folder_, kPrefix); }

// False where the file is of another meaning.
bool SampleLog::read(File& file, const Visit& visit, std::string& why) {
  const std::string path = path_of(file.number);
  std::string failure;
  const std::optional<std::string> all = config::read_whole_file(path, failure);
  if (!all) {
    why = path + " cannot be read: " + failure;
    return true;
  }
  std::string_view bytes = *all;
  if (!bytes.starts_with(kMagic)) {
    why = path + ": some of it is damaged";
    return true;
  }
  bytes.remove_prefix(kMagic.size());
  const auto meaning = next_record(bytes);
  if (!meaning) {
    if (!bytes.empty()) why = path + ": some of it is damaged";
    return true;
  }
  if (*meaning != meaning_) return false;
  std::array<std::uint64_t, kSignalKindCount> blocks{};
  Block block;
  while (const auto record = next_record(bytes)) {
    if (*record == kExpiry) {
      visit(nullptr);
    } else if (decode(*record, block)) {
      visit(&block.view);
      auto& count = blocks[static_cast<std::size_t>(block.view.kind)];
      file.intervals = std::max(file.intervals, ++count);
    }
  }
  // The last record of a file may be torn; what is behind it would have been written later.
  if (!bytes.empty()) why = path + ": some of it is damaged";
  return true;
}

std::string SampleLog::recall(const Visit& visit, std::uint64_t from, const Visit& earlier) {
  std::vector<std::string> lost;
  bool changed = false;
  files_.clear();
  std::error_code unreadable;
  (void)fs::directory_iterator(folder_, unreadable);
  if (unreadable && unreadable != std::errc::no_such_file_or_directory)
    lost.push_back(folder_ + " cannot be read: " + config::failure_text(unreadable.value()));
  const Visit ignore = [](const BlockView*) {};
  const Visit& before = earlier ? earlier : ignore;
  // Of another meaning is what was before the unit file changed: what follows is a new beginning.
  for (const std::uint64_t number : files()) {
    File file{number, 0};
    std::string why;
    if (read(file, number < from ? before : visit, why)) {
      files_.push_back(file);
      if (!why.empty() && number >= from) lost.push_back(why);
      continue;
    }
    changed = true;
    std::error_code ignored;
    fs::remove(path_of(number), ignored);
  }
  // A new file is begun for what comes: behind a torn record nothing is found again.
  if (lost.empty()) return changed ? kChanged : "";
  return lost.front() +
         (lost.size() == 1 ? "" : ", and " + counted(lost.size() - 1, "file") + " more like it");
}

std::optional<std::uint64_t> SampleLog::push(const BlockView& block) {
  std::uint64_t& blocks = blocks_[static_cast<std::size_t>(block.kind)];
  const bool begins = !begun_ || blocks > keep_ / kFiles;
  if (begins) begin_file();
  ++blocks;
  if (descriptor_ >= 0) files_.back().intervals = std::max(files_.back().intervals, blocks);
  record_.clear();
  encode(block, record_);
  append(record_);
  return begins && descriptor_ >= 0 ? std::optional(last()) : std::nullopt;
}

bool SampleLog::full() const {
  return begun_ && std::any_of(blocks_.begin(), blocks_.end(),
                               [this](std::uint64_t blocks) { return blocks > keep_ / kFiles; });
}

std::optional<std::uint64_t> SampleLog::begin_next() {
  begin_file();
  return descriptor_ >= 0 ? std::optional(last()) : std::nullopt;
}

void SampleLog::push_expiry() { append(kExpiry); }

void SampleLog::append(std::string_view payload) {
  if (descriptor_ < 0) return;
  bytes_.clear();
  put(bytes_, static_cast<std::uint32_t>(payload.size()));
  put(bytes_, sum_of(payload));
  bytes_.append(payload);
  write(bytes_);
}

// What did not fit leaves the file torn: what comes goes into the next one.
void SampleLog::write(std::string_view bytes) {
  if (descriptor_ < 0) return;
  const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
  if (written == static_cast<ssize_t>(bytes.size())) return;
  if (written >= 0) errno = ENOSPC;  // a part of it fitted
  fail("cannot be written");
}

void SampleLog::begin_file() {
  close_file();
  begun_ = true;
  blocks_.fill(0);
  std::error_code failed;
  if (!fs::exists(folder_, failed)) {
    if (!fs::create_directories(folder_, failed) && failed) {
      errno = failed.value();
      return fail("cannot be made");
    }
    fs::permissions(folder_, fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec,
                    failed);
    // Its name, and that of the folder of all units: whatever will be synced in there rests on
    // them.
    const fs::path all_units = fs::path(folder_).parent_path();
    sync_path(all_units);
    sync_path(all_units.parent_path());
  }
  const std::uint64_t number = last() + 1;
  descriptor_ = ::open(path_of(number).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_APPEND,
                       S_IRUSR | S_IWUSR | S_IRGRP);
  if (descriptor_ < 0) return fail("cannot be made");
  files_.push_back({number, 0});
  problem_.clear();
  write(kMagic);
  append(meaning_);
  std::uint64_t others = 0;
  for (const File& file : files_) others += file.intervals;
  const auto surplus = [&] {
    const std::uint64_t most = files_.front().number < held_from_ ? keep_ : kMostHeld * keep_;
    return others - files_.front().intervals >= most;
  };
  while (files_.size() > 1 && surplus()) {
    others -= files_.front().intervals;
    fs::remove(path_of(files_.front().number), failed);
    files_.pop_front();
  }
}

void SampleLog::close_file() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

void SampleLog::fail(const std::string& doing) {
  problem_ = folder_ + " " + doing + ": " + std::strerror(errno);
  close_file();
}

}  // namespace mpm::live
