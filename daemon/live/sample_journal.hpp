#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/record/alarm_record.hpp"
#include "core/record/channel_record.hpp"

namespace mpm::live {

/// JSON lines of every record of every sample, appended to a file: for comparing monitors, a
/// gigabyte a day of nine channels at 1 s. On disk (as far as the kernel) after each frame.
class SampleJournal {
 public:
  /// Throws std::system_error if the file cannot be written.
  explicit SampleJournal(const std::string& path);

  /// All channels after one frame, then the alarms that it changed. False if the file would not
  /// take it (full disk ...); what it does not take is lost.
  [[nodiscard]] bool write(const std::vector<ChannelRecord>& channels,
                           const std::vector<AlarmRecord>& alarms);
  /// Why the last write failed; empty if it did not.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::string lines_;
  std::string problem_;
};

}  // namespace mpm::live
