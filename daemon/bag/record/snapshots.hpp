#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/bag/record/recording_files.hpp"

namespace mpm::bag {

struct SnapshotOptions {
  std::int64_t before_ns = 0;     ///< saved before the moment; 0 = there are no snapshots
  std::int64_t after_ns = 0;      ///< saved after it
  std::uint64_t quota_bytes = 0;  ///< no snapshot begins while those there are take more; 0 = none
  bool drop_oldest = false;       ///< then the oldest make room
};

/// The name of the snapshot for a sample of mpm/alarm_event, "UNIT-MV-CV-20240501T120000Z" by the
/// alarm's source time; nothing where it is no alarm that became active.
[[nodiscard]] std::optional<std::string> alarm_snapshot(std::span<const std::byte> cdr);
/// The name of one that was asked for by hand: "by-hand-20240501T120000Z".
[[nodiscard]] std::string hand_snapshot(std::int64_t now_ns);

/// Saves the files of a recording that lie around a moment: each gets a second name (a hard link)
/// in the folder `saved/NAME` beside it, so it stays when the recording deletes its own, and
/// snapshots that overlap take their place on the disk once. One that is cut off, of a recorder
/// that was killed, is mended there. A snapshot whose recorder was killed holds what was complete
/// by then; begun again under its name it goes on.
class Snapshots {
 public:
  /// `folder`: of the recording.
  Snapshots(const std::filesystem::path& folder, const SnapshotOptions& options);

  [[nodiscard]] bool wanted() const { return options_.before_ns > 0; }
  /// Throws std::invalid_argument where `file` cannot have a second name in there.
  void check(const std::filesystem::path& file) const;

  /// Of the moment `time_ns`; what is later than `now_ns` counts as now. `after_ns` may differ from
  /// that of the options. A moment so long ago that all of it is past is none: what a monitor said
  /// long ago is told to every recorder that starts.
  void begin(const std::string& name, std::int64_t time_ns, std::int64_t after_ns,
             std::int64_t now_ns, const std::deque<RecordingFiles::File>& complete);
  /// True where the file that is being written has to end for one of them.
  [[nodiscard]] bool due(std::int64_t now_ns) const;
  /// A file is complete: into all that are open. Ends those that are due.
  void add(const RecordingFiles::File& file, std::int64_t now_ns);
  /// The recording is over, and with it those that are open.
  void finish();

  /// What there is to tell since the last call, in whole sentences.
  [[nodiscard]] std::vector<std::string> take_news();

 private:
  struct Open {
    std::filesystem::path folder;
    std::int64_t end_ns = 0;
    std::int64_t first_ns = 0, last_ns = 0;  // of what is in it
    std::size_t files = 0;
  };

  [[nodiscard]] bool has_room(const std::string& name);
  void save(const RecordingFiles::File& file, Open& snapshot);
  void tell_saved(const Open& snapshot, const std::string& how);

  std::filesystem::path folder_;
  SnapshotOptions options_;
  std::vector<Open> open_;
  std::vector<std::string> news_;
};

}  // namespace mpm::bag
