#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/parallel/mutex.hpp"
#include "daemon/history/alarm_store.hpp"
#include "idl/condition_variable.hpp"

namespace mpm::live {

/// Writes what happens to alarms into their journal, in a thread of its own: a disk that is slow or
/// full delays no sample. What cannot be written now waits, up to a limit. A file that is damaged
/// is put aside under another name, and a new one begun, as where somebody has removed it.
class AlarmJournal {
 public:
  /// Whether the file was never a journal: somebody has named it by mistake, and it is none to be
  /// put aside.
  [[nodiscard]] static bool is_foreign(const std::string& path) {
    return history::is_foreign(path);
  }
  /// Makes or opens the file; where that cannot be done now it is tried again and again.
  explicit AlarmJournal(const std::string& path);
  /// Writes what waits.
  ~AlarmJournal();
  AlarmJournal(const AlarmJournal&) = delete;
  AlarmJournal& operator=(const AlarmJournal&) = delete;

  /// From now on the samples of `unit`, which a SampleLog keeps in `folder`, come to the disk
  /// before what they tell of its alarms: after a power cut the alarms stand as the samples have
  /// it.
  void rest_on(const std::string& unit, const std::string& folder);
  void push(history::AlarmEntry entry);
  /// How the alarms of a unit stood when they were last written of; nothing where nobody can tell.
  [[nodiscard]] std::vector<history::AlarmEntry> before(const std::string& unit);
  /// Why nothing can be written; empty: all is well.
  [[nodiscard]] std::string problem() const;
  /// What was put aside and why, or that the file was removed, in words; empty: neither.
  [[nodiscard]] std::string put_aside() const;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  void run();
  void open();
  void put_aside(const std::string& why);
  void sync_samples(const std::vector<history::AlarmEntry>& entries) const;

  std::string path_;
  std::optional<history::AlarmStore> store_;  // of the thread alone, once it runs
  mutable Mutex mutex_;
  ConditionVariable changed_;
  std::map<std::string, std::string> samples_ MPM_GUARDED_BY(mutex_);  // folder, by unit
  std::vector<history::AlarmEntry> waiting_ MPM_GUARDED_BY(mutex_);
  std::uint64_t lost_ MPM_GUARDED_BY(mutex_) = 0;
  std::string problem_ MPM_GUARDED_BY(mutex_);
  std::string put_aside_ MPM_GUARDED_BY(mutex_);
  std::string damage_ MPM_GUARDED_BY(mutex_);  // that a reader found; the thread is to see to it
  bool stopped_ MPM_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace mpm::live
