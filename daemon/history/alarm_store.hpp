#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/alarm/alarm_settings.hpp"
#include "core/alarm/managed_alarm.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace mpm::history {

/// Something that happened to an alarm, or that somebody wanted to happen.
struct AlarmEntry {
  std::int64_t written_ns = 0;  ///< UTC
  std::int64_t source_time_ns = 0;
  std::string unit, mv, cv;  ///< no mv, no cv: the controller's alarm
  std::string what;          ///< a word of AlarmOccurrence, or "refused"
  AlarmStanding standing;    ///< after it
  NotificationClass notification_class = NotificationClass::kAlert;
  AlarmPriority priority = AlarmPriority::kLow;
  std::string user, host, comment;  ///< of the command that did it; empty: nobody did
  std::string message;
};

/// Which entries; empty: all.
struct AlarmQuery {
  std::optional<std::int64_t> since_ns, until_ns;  ///< written, UTC; the second is left out
  std::string unit, mv, cv;
};

/// What `verify` found; `problem` empty: nothing wrong.
struct StoreCheck {
  std::uint64_t entries = 0;
  std::string problem;
};

/// What is in the file is no journal, or no longer: no later try will do better.
class DamagedStore : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Whether a file is there that was never a journal: it holds something, and not what every SQLite
/// file begins with. False where nobody can tell.
[[nodiscard]] bool is_foreign(const std::string& path);

/// The journal of all alarms of a daemon, one SQLite file: entries are added and never changed; of
/// more than `kMostEntries` the oldest go. An entry that was appended survives whatever becomes of
/// the process or the machine. Each carries a SHA-256 over itself and the one before: what was
/// changed afterwards, or is missing between two, shows. Throws std::runtime_error,
/// or DamagedStore.
class AlarmStore {
 public:
  static constexpr std::int64_t kMostEntries = 1'000'000;

  enum class Access { kRead, kAppend };
  /// Appending makes the file where there is none. `most`: kMostEntries, but for tests.
  AlarmStore(const std::string& path, Access access, std::int64_t most = kMostEntries);
  ~AlarmStore();
  AlarmStore(const AlarmStore&) = delete;
  AlarmStore& operator=(const AlarmStore&) = delete;

  /// Whether the file that was opened still is where it was: what is written to one that somebody
  /// has removed is lost, and SQLite does not say so.
  [[nodiscard]] bool in_place() const;
  /// All of them, or none.
  void append(const std::vector<AlarmEntry>& entries);
  /// In the order of writing.
  void each(const AlarmQuery& query, const std::function<void(const AlarmEntry&)>& visit) const;
  /// At most so many, the youngest first.
  [[nodiscard]] std::vector<AlarmEntry> youngest(const AlarmQuery& query, std::size_t most) const;
  /// The last entry of each alarm of the unit, commands that were refused apart.
  [[nodiscard]] std::vector<AlarmEntry> last_of_each(const std::string& unit) const;
  /// Reads everything.
  [[nodiscard]] StoreCheck verify() const;

 private:
  struct CloseStatement {
    void operator()(sqlite3_stmt* statement) const;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, CloseStatement>;

  void run(const std::string& sql) const;
  void select(const AlarmQuery& query, const std::string& order,
              const std::function<void(const AlarmEntry&)>& visit) const;
  [[nodiscard]] Statement prepare(const std::string& sql) const;
  void check_is_journal() const;
  [[noreturn]] void fail(const std::string& doing) const;
  void insert(sqlite3_stmt* statement, const AlarmEntry& entry);

  std::string path_;
  std::int64_t most_;
  sqlite3* database_ = nullptr;
  std::optional<std::pair<std::uint64_t, std::uint64_t>> opened_;  // device and inode
  std::string link_;                                               // of the last entry
};

}  // namespace mpm::history
