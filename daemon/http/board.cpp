#include "daemon/http/board.hpp"

#include <utility>

#include "daemon/http/kept_digests.hpp"

namespace mpm::http {
namespace {

constexpr std::chrono::milliseconds kFetchPeriod{100};
// A second's reading.
constexpr std::uint64_t kMostJournalBytes = 64'000'000;

}  // namespace

Board::Board(const std::vector<config::UnitConfig>& units, std::string journal)
    : journal_(std::move(journal)) {
  for (const config::UnitConfig& unit : units)
    units_[unit.unit] = std::make_unique<Unit>(unit, events_);
}

Board::~Board() {
  close();
  if (thread_.joinable()) thread_.join();
}

void Board::start() {
  thread_ = std::thread([this] { run(); });
}

void Board::run() {
  recall_digests();
  Clock::time_point next = Clock::now();
  for (;;) {
    fetch(next);
    next += kFetchPeriod;
    MutexLock lock(mutex_);
    while (!closed_ && changed_.wait_until(lock, next)) {
    }
    if (closed_) return;
  }
}

// Of all units no more than a page may take of the time in which it shows nothing.
void Board::recall_digests() {
  if (journal_.empty()) return;
  for (const auto& [name, unit] : units_) {
    if (closed()) return;
    UnitStore& store = unit->store;
    for_each_kept_digest(journal_, name, kMostJournalBytes / units_.size(),
                         [&store](const history::Digest& digest) { store.recall(digest); });
  }
}

void Board::fetch(Clock::time_point now) {
  const MutexLock one(fetching_);
  bool news = false;
  for (const auto& [name, unit] : units_) {
    unit->spare.clear();
    unit->feed.fetch(unit->spare);
    news = unit->store.absorb(unit->spare, now) || news;
  }
  if (!news) return;
  const MutexLock lock(mutex_);
  ++version_;
  changed_.notify_all();
}

UnitFeed* Board::feed_of(const std::string& unit) {
  const auto found = units_.find(unit);
  return found == units_.end() ? nullptr : &found->second->feed;
}

const UnitStore* Board::find(const std::string& unit) const {
  const auto found = units_.find(unit);
  return found == units_.end() ? nullptr : &found->second->store;
}

std::uint64_t Board::version() const {
  const MutexLock lock(mutex_);
  return version_;
}

std::uint64_t Board::wait_beyond(std::uint64_t version, Clock::time_point deadline) const {
  MutexLock lock(mutex_);
  while (!closed_ && version_ <= version && changed_.wait_until(lock, deadline)) {
  }
  return version_;
}

void Board::close() {
  const MutexLock lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

bool Board::closed() const {
  const MutexLock lock(mutex_);
  return closed_;
}

}  // namespace mpm::http
