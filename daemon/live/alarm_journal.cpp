#include "daemon/live/alarm_journal.hpp"

#include <chrono>
#include <ctime>
#include <exception>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "daemon/files/times/time_text.hpp"
#include "daemon/live/sample_log.hpp"

namespace mpm::live {
namespace {

constexpr std::size_t kMostWaiting = 10'000;  // entries, about 5 MB
constexpr std::chrono::seconds kRetry{1};
constexpr std::chrono::seconds kLook{5};  // whether the file is still there

}  // namespace

AlarmJournal::AlarmJournal(const std::string& path) : path_(path) {
  try {
    open();
  } catch (const std::exception& error) {
    problem_ = error.what();
  }
  thread_ = std::thread([this] { run(); });
}

AlarmJournal::~AlarmJournal() {
  {
    const MutexLock lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void AlarmJournal::rest_on(const std::string& unit, const std::string& folder) {
  const MutexLock lock(mutex_);
  samples_[unit] = folder;
}

void AlarmJournal::push(history::AlarmEntry entry) {
  {
    const MutexLock lock(mutex_);
    if (waiting_.size() < kMostWaiting)
      waiting_.push_back(std::move(entry));
    else
      ++lost_;
  }
  changed_.notify_all();
}

std::vector<history::AlarmEntry> AlarmJournal::before(const std::string& unit) {
  try {  // a reader of its own: the store is the thread's
    return history::AlarmStore(path_, history::AlarmStore::Access::kRead).last_of_each(unit);
  } catch (const history::DamagedStore& error) {
    {
      const MutexLock lock(mutex_);
      damage_ = error.what();
    }
    changed_.notify_all();
  } catch (const std::exception&) {  // `problem` tells
  }
  return {};
}

std::string AlarmJournal::put_aside() const {
  const MutexLock lock(mutex_);
  return put_aside_;
}

void AlarmJournal::open() {
  try {
    store_.emplace(path_, history::AlarmStore::Access::kAppend);
  } catch (const history::DamagedStore& error) {
    put_aside(error.what());
    store_.emplace(path_, history::AlarmStore::Access::kAppend);
  }
}

// With what SQLite keeps beside it: all of it may be wanted by who mends it.
void AlarmJournal::put_aside(const std::string& why) {
  store_.reset();
  std::error_code unknown;
  const bool removed = !std::filesystem::exists(path_, unknown);
  const std::string name =
      path_ + ".damaged-" + files::formatted_utc(std::time(nullptr), "%Y%m%dT%H%M%SZ");
  for (const char* part : {"", "-wal", "-shm"}) {
    std::error_code failed;
    if (!std::filesystem::exists(path_ + part, failed)) continue;
    std::filesystem::rename(path_ + part, name + part, failed);
    if (failed) throw std::runtime_error(why + "; it cannot be put aside: " + failed.message());
  }
  const MutexLock lock(mutex_);
  if (removed) {
    put_aside_ = "the journal of alarms was removed while it was written: what was in " + path_ +
                 " is lost, and it begins anew";
    return;
  }
  put_aside_ = "the journal of alarms is damaged (" + why + "): it is kept as " + name +
               ", and a new one was begun";
}

std::string AlarmJournal::problem() const {
  const MutexLock lock(mutex_);
  if (lost_ == 0) return problem_;
  return (problem_.empty() ? "" : problem_ + "; ") + std::to_string(lost_) + " entries are lost";
}

void AlarmJournal::sync_samples(const std::vector<history::AlarmEntry>& entries) const {
  std::set<std::string> folders;
  {
    const MutexLock lock(mutex_);
    for (const history::AlarmEntry& entry : entries)
      if (const auto found = samples_.find(entry.unit); found != samples_.end())
        folders.insert(found->second);
  }
  for (const std::string& folder : folders) SampleLog::sync(folder);
}

void AlarmJournal::run() {
  MutexLock lock(mutex_);
  while (true) {
    const auto look = std::chrono::steady_clock::now() + kLook;
    while (!stopped_ && waiting_.empty() && damage_.empty() && changed_.wait_until(lock, look)) {
    }
    if (stopped_ && waiting_.empty() && damage_.empty()) return;
    std::vector<history::AlarmEntry> batch = std::exchange(waiting_, {});
    const std::string damage = std::exchange(damage_, {});
    lock.unlock();
    std::string problem;
    try {
      const bool moved = store_ && !store_->in_place();
      if (moved || !damage.empty()) put_aside(moved ? "another file is in its place" : damage);
      if (!store_) open();
      sync_samples(batch);
      try {
        if (!batch.empty()) store_->append(batch);
      } catch (const history::DamagedStore& error) {
        put_aside(error.what());
        open();
        store_->append(batch);
      }
    } catch (const std::exception& error) {
      problem = error.what();
    }
    lock.lock();
    problem_ = problem;
    if (problem.empty()) continue;
    if (stopped_) return;
    batch.insert(batch.end(), std::make_move_iterator(waiting_.begin()),
                 std::make_move_iterator(waiting_.end()));
    waiting_ = std::move(batch);
    const auto retry = std::chrono::steady_clock::now() + kRetry;
    while (!stopped_ && changed_.wait_until(lock, retry)) {
    }
  }
}

}  // namespace mpm::live
