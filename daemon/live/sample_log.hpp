#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/signal/aligner.hpp"

namespace mpm::live {

/// What a unit took from its topics last, on disk in the order in which it came, so that a process
/// that begins where another one ended can take it again. A record is handed to the system before
/// it is acted upon: `kill -9` loses none; a power cut may, those since `sync` or of the last half
/// minute, and what it tore is left out. Numbered files, of which the oldest goes when the others
/// hold enough.
class SampleLog {
 public:
  /// One of the records: a block, or null where the aligner was told that nothing more will come
  /// (`Aligner::expire`).
  using Visit = std::function<void(const BlockView*)>;
  /// Within what is kept.
  static constexpr std::uint64_t kFiles = 64;
  static constexpr std::uint64_t kMostHeld = 8;

  /// `meaning`: of the values; what was kept with another one is of no use and goes. `keep`:
  /// intervals, at least. Touches nothing yet.
  SampleLog(std::string folder, std::string meaning, std::uint64_t keep);
  SampleLog(const SampleLog&) = delete;
  SampleLog& operator=(const SampleLog&) = delete;
  ~SampleLog();

  /// The numbers of the files that there are, ascending.
  [[nodiscard]] std::vector<std::uint64_t> files() const;
  /// Why what was kept is not used although nothing is wrong with it.
  static constexpr const char* kChanged = "the unit file has changed what it means";
  /// To be called once, before anything is added: all that is there, oldest first; what comes
  /// before the beginning of file `from` goes to `earlier`, where that is any. Returns why some of
  /// what goes to `visit` is not used, with the file, in words; empty: all is.
  std::string recall(const Visit& visit, std::uint64_t from = 0, const Visit& earlier = nullptr);
  /// Never throws for the disk: see `problem`. The number of the file that begins with this block,
  /// where one does.
  std::optional<std::uint64_t> push(const BlockView& block);
  /// Whether the next block begins a file for what the last one holds.
  [[nodiscard]] bool full() const;
  /// The next block begins a file of this number; nothing where there can be none.
  std::optional<std::uint64_t> begin_next();
  /// Of the last file; 0: there is none.
  [[nodiscard]] std::uint64_t last() const { return files_.empty() ? 0 : files_.back().number; }
  void push_expiry();
  /// From now on files from this one on stay, whatever the others hold, up to `kMostHeld` times
  /// `keep`: a state stands before them.
  void hold_from(std::uint64_t file) { held_from_ = file; }
  /// Brings what stands in `folder` to the disk, which may take long: from any thread.
  static void sync(const std::string& folder);
  [[nodiscard]] const std::string& folder() const { return folder_; }
  /// Why nothing can be kept now; empty: it can. It is tried again when the next file is due.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  struct File {
    std::uint64_t number = 0;
    std::uint64_t intervals = 0;
  };

  [[nodiscard]] std::string path_of(std::uint64_t number) const;
  bool read(File& file, const Visit& visit, std::string& why);
  void append(std::string_view payload);
  void write(std::string_view bytes);
  void begin_file();
  void close_file();
  void fail(const std::string& doing);

  std::string folder_;
  std::string meaning_;
  std::uint64_t keep_;
  std::uint64_t held_from_ = std::numeric_limits<std::uint64_t>::max();
  std::deque<File> files_;  // the last one is written to, while descriptor_ is open
  int descriptor_ = -1;
  bool begun_ = false;                                    // a file, or it was tried
  std::array<std::uint64_t, kSignalKindCount> blocks_{};  // since then
  std::string record_, bytes_;                            // kept for their memory
  std::string problem_;
};

}  // namespace mpm::live
