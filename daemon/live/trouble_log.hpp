#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "daemon/bus/trouble.hpp"

namespace mpm::live {

/// Which troubles stand, so that each is told once when it begins and once when it is over. One
/// that comes again within `calm` has not been over: what comes and goes does not flood a log.
class TroubleLog {
 public:
  using Clock = std::chrono::steady_clock;

  struct Line {
    bool begins = true;
    std::string text;
  };

  explicit TroubleLog(Clock::duration calm = std::chrono::seconds(30)) : calm_(calm) {}

  /// `troubles`: all that there are now. Returns what is to be said of the change.
  [[nodiscard]] std::vector<Line> update(const std::vector<bus::Trouble>& troubles,
                                         Clock::time_point now);

 private:
  struct Entry {
    std::string text;  // as it was told
    Clock::time_point began, seen;
  };

  Clock::duration calm_;
  std::map<std::string, Entry> standing_;  // by key
};

}  // namespace mpm::live
