#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <system_error>

namespace mpm::history {

/// The numbered files of one unit's journal, FOLDER/UNIT-000001.jsonl and so on: no file grows far
/// beyond a sixteenth of what is kept, and the oldest go first.
class JournalFiles {
 public:
  using Clock = std::chrono::steady_clock;

  /// Makes the folder, but not those above it, and begins a file behind those that are there.
  /// `unit`: as it is in file names. Where that cannot be, `problem` says why, and it is tried
  /// again.
  JournalFiles(const std::string& folder, const std::string& unit, std::uint64_t keep_bytes);
  JournalFiles(JournalFiles&& other) noexcept;
  JournalFiles(const JournalFiles&) = delete;
  JournalFiles& operator=(const JournalFiles&) = delete;
  ~JournalFiles();

  /// Begins the next file if the one at hand is full or was removed. What fails here is tried again
  /// by `append`.
  void turn_over();
  /// Nothing stands in the file at hand.
  [[nodiscard]] bool empty() const { return bytes_ == 0; }
  /// All of `text`, or nothing of it: false, and `problem` says why. With the next call it goes on.
  [[nodiscard]] bool append(std::string_view text);
  /// Why the last `append` failed, or why no file could be begun, first or for one that was
  /// removed; empty if all is well.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  struct File {
    int number = 0;
    std::uint64_t bytes = 0;
  };

  [[nodiscard]] std::string path_of(int number) const;
  void begin();
  [[nodiscard]] std::error_code find_earlier();
  [[nodiscard]] bool open_next();
  void make_room();

  std::string folder_, unit_;
  std::uint64_t keep_bytes_, file_bytes_;
  std::deque<File> earlier_;  // oldest first, without the one at hand
  bool begun_ = false;        // the first file
  Clock::time_point next_try_{};
  int number_ = 0;
  int descriptor_ = -1;
  std::uint64_t bytes_ = 0;  // of the file at hand
  std::string problem_;
};

/// Of `name`, a file's without its folder: the unit as it is in file names, and the number; false
/// where it is no journal's.
[[nodiscard]] bool parse_journal_name(std::string_view name, std::string& unit, int& number);

}  // namespace mpm::history
