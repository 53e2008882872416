#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "daemon/bus/trouble.hpp"
#include "daemon/host/rate_limiter.hpp"

namespace mpm::live {

/// Which troubles stand, so that each is told when it begins, when it turns into something else,
/// and when it is over. One that comes again within `calm` has not been over: what comes and goes
/// does not flood a log. What only happens once, an event, is told once and never over. Of one key
/// a few lines a minute are told, and how many more there were.
class TroubleLog {
 public:
  using Clock = std::chrono::steady_clock;

  /// How long one lasted counts from when it has been so, where the trouble knows, as its text
  /// does.
  struct Line {
    bool begins = true;
    std::string text;
  };

  explicit TroubleLog(Clock::duration calm = std::chrono::seconds(30)) : calm_(calm) {}

  /// `troubles`: all that there are now. `wall_s`: UTC since 1970. Returns what is to be said of
  /// the change.
  [[nodiscard]] std::vector<Line> update(const std::vector<bus::Trouble>& troubles,
                                         Clock::time_point now, std::int64_t wall_s);

 private:
  struct Entry {
    bool event = false;
    std::set<std::string> told;  // texts, without their numbers
    std::string text;            // as it stood last
    Clock::time_point came, seen;
    Clock::duration stood{};  // the times before `came`
    int times = 1;
    std::int64_t ended_s = 0;  // wall clock
  };

  void tell(const bus::Trouble& trouble, Clock::time_point now, std::vector<Line>& lines);

  Clock::duration calm_;
  std::map<std::string, Entry> standing_;            // by key, and event
  std::map<std::string, host::RateLimiter> limits_;  // by key
};

}  // namespace mpm::live
