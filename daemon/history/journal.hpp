#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/record/health_record.hpp"
#include "daemon/history/digest_maker.hpp"
#include "daemon/history/journal_files.hpp"

namespace mpm::history {

/// What is to be known later of one unit, as JSON lines that a disk can bear for years: alarms, a
/// channel's record when its verdict, reason or alarm changes, the health when its state does, and
/// a digest a minute (`DigestMaker`). All but the health is a function of the samples alone.
///
/// Each file can be read alone: it begins with the unit's head (`UnitHead`), and with the records
/// of all channels as they stand. So it goes on after trouble with the disk, too.
class Journal {
 public:
  Journal(const config::UnitConfig& unit, JournalFiles files);

  /// After each `monitor.push`.
  void push(report::UnitMonitor& monitor);
  /// Writes it if its state is another than before.
  void push(const HealthRecord& health);
  /// The last digest, however short its time was.
  void finish();

  /// Why the last line was not written; empty if it was. What could not be written is lost.
  [[nodiscard]] const std::string& problem() const { return files_.problem(); }

 private:
  /// What of a channel is written when it changes.
  struct Said {
    Verdict verdict = Verdict::kUndetermined;
    Reason reason = Reason::kNone;
    int confounder = -1;
    AlarmState alarm = AlarmState::kCleared;
    bool operator==(const Said&) const = default;
  };

  [[nodiscard]] std::vector<Said> said_by(const Monitor& monitor) const;
  void add(const std::string& line) { lines_.append(line).append("\n"); }
  void add_changes(report::UnitMonitor& monitor);
  void write();

  std::string unit_;
  int inputs_, cvs_;
  JournalFiles files_;
  DigestMaker digests_;
  std::vector<Said> said_;  // as written; empty: nothing stands in this file
  std::string health_;      // its state as written
  std::string lines_;
};

}  // namespace mpm::history
