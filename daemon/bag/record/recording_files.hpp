#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <string>

namespace mpm::bag {

/// Which files a recording becomes, and which of them have to go.
///
/// OUTPUT ending in `.mcap`: that file, or `name-0001.mcap`, `name-0002.mcap` ... where files are
/// split. Anything else is a folder, made if need be, of files `mpm-20260131T235959Z-0001.mcap`, or
/// `ring-...` where only the last hours are kept.
/// Numbers go on behind the highest that is there. Earlier numbered files of the same name, in a
/// folder all recordings with names as above, count for the quota and go first; no other file is
/// ever deleted.
class RecordingFiles {
 public:
  struct File {
    std::filesystem::path path;
    std::uint64_t bytes = 0;
    std::int64_t start_ns = 0, end_ns = 0;  ///< log times, UTC since 1970
    bool whole = true;
  };

  /// `start_ns`: UTC since 1970. `quota_bytes` and `keep_ns` 0: no limit. Where there is a
  /// `keep_ns` earlier files are looked into for their times; one that tells none ends at
  /// `start_ns`. Throws std::runtime_error where the folder cannot be made.
  RecordingFiles(const std::string& output, bool split, std::uint64_t quota_bytes,
                 std::int64_t start_ns, std::int64_t keep_ns = 0);

  /// The next file's path, of none that is there. Throws std::invalid_argument where a file without
  /// a number is there already.
  [[nodiscard]] std::string next();
  /// A file is complete.
  void finished(File file);
  /// Deletes the oldest until all that are left and `room` bytes fit the quota and none ended
  /// longer ago than is to be kept; the newest one stays in any case.
  void make_room(std::uint64_t room, std::int64_t now_ns);

  /// Those that are complete, the oldest first.
  [[nodiscard]] const std::deque<File>& complete() const { return files_; }
  [[nodiscard]] std::uint64_t deleted() const { return deleted_; }

 private:
  /// `of_any_time`: whatever recording in this folder they belong to.
  void find_earlier(bool of_any_time, std::int64_t start_ns);

  std::filesystem::path folder_;
  std::string stem_;
  bool numbered_;
  std::uint64_t quota_bytes_;
  std::int64_t keep_ns_;
  int number_ = 0;
  std::deque<File> files_;  // oldest first
  std::uint64_t deleted_ = 0;
};

}  // namespace mpm::bag
