#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "config/unit_config.hpp"
#include "core/parallel/mutex.hpp"
#include "daemon/http/recent_events.hpp"
#include "daemon/http/unit_feed.hpp"
#include "daemon/http/unit_store.hpp"
#include "idl/condition_variable.hpp"

namespace mpm::http {

/// All units for who looks at them. A thread of its own fetches what their feeds have noted, so
/// that the event loop waits for nobody, and nobody who draws months of values for the event loop.
class Board {
 public:
  using Clock = std::chrono::steady_clock;
  struct Unit {
    Unit(const config::UnitConfig& config, RecentEvents& events)
        : feed(config), store(config, events) {}
    UnitFeed feed;
    UnitStore store;
    Delivery spare;
  };

  /// `journal`: the folder of the units' journals, whose digests it takes before all else, once
  /// begun; empty: there is none.
  explicit Board(const std::vector<config::UnitConfig>& units, std::string journal = "");
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;
  ~Board();

  /// Begins to fetch. Feeds may be written before.
  void start();
  /// Fetches all there is now; from any thread, one at a time.
  void fetch(Clock::time_point now);

  [[nodiscard]] UnitFeed* feed_of(const std::string& unit);
  /// Null where there is none of this name.
  [[nodiscard]] const UnitStore* find(const std::string& unit) const;
  [[nodiscard]] const std::map<std::string, std::unique_ptr<Unit>>& units() const { return units_; }
  [[nodiscard]] const RecentEvents& events() const { return events_; }

  /// Counts up whenever anything can be seen that could not before.
  [[nodiscard]] std::uint64_t version() const;
  /// Waits for a later version, until `deadline` or until the board closes. Returns what there is.
  [[nodiscard]] std::uint64_t wait_beyond(std::uint64_t version, Clock::time_point deadline) const;
  /// Nobody waits any more.
  void close();
  [[nodiscard]] bool closed() const;

 private:
  void run();
  void recall_digests();

  std::string journal_;
  RecentEvents events_;
  std::map<std::string, std::unique_ptr<Unit>> units_;
  Mutex fetching_;  // of all units' `spare`, and what is behind their feeds in its order
  mutable Mutex mutex_;
  mutable ConditionVariable changed_;
  std::uint64_t version_ MPM_GUARDED_BY(mutex_) = 0;
  bool closed_ MPM_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace mpm::http
