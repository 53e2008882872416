#include "daemon/live/alarm_journal.hpp"

#include <chrono>
#include <exception>
#include <set>
#include <utility>

#include "daemon/live/sample_log.hpp"

namespace mpm::live {
namespace {

constexpr std::size_t kMostWaiting = 10'000;  // entries, about 5 MB
constexpr std::chrono::seconds kRetry{1};

}  // namespace

AlarmJournal::AlarmJournal(const std::string& path) : path_(path) {
  try {
    store_.emplace(path_, history::AlarmStore::Access::kAppend);
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

std::vector<history::AlarmEntry> AlarmJournal::before(const std::string& unit) const {
  try {  // a reader of its own: the store is the thread's
    return history::AlarmStore(path_, history::AlarmStore::Access::kRead).last_of_each(unit);
  } catch (const std::exception&) {
    return {};  // `problem` tells
  }
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
    while (!stopped_ && waiting_.empty()) changed_.wait(lock);
    if (waiting_.empty()) return;
    std::vector<history::AlarmEntry> batch = std::exchange(waiting_, {});
    lock.unlock();
    std::string problem;
    try {
      if (!store_) store_.emplace(path_, history::AlarmStore::Access::kAppend);
      sync_samples(batch);
      store_->append(batch);
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
