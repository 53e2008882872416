#include "daemon/http/board.hpp"

namespace mpm::http {
namespace {

constexpr std::chrono::milliseconds kFetchPeriod{100};

}  // namespace

Board::Board(const std::vector<config::UnitConfig>& units) {
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
