#pragma once

#include <chrono>
#include <cstdint>

namespace mpm::host {

/// Keeps one kind of message from flooding the log: the first few of each period pass, the first
/// one of a later period tells how many did not.
class RateLimiter {
 public:
  using Clock = std::chrono::steady_clock;

  explicit RateLimiter(int burst = 5, Clock::duration period = std::chrono::minutes(1))
      : burst_(burst), period_(period) {}

  /// True if a message may be logged now.
  [[nodiscard]] bool admit(Clock::time_point now) {
    if (now >= period_end_) {
      period_end_ = now + period_;
      passed_ = 0;
      summary_ = suppressed_;
      suppressed_ = 0;
    }
    if (passed_ >= burst_) {
      ++suppressed_;
      return false;
    }
    if (++passed_ > 1) summary_ = 0;
    return true;
  }

  /// How many were held back before the message just admitted.
  [[nodiscard]] std::uint64_t held_back() const { return summary_; }

 private:
  int burst_;
  Clock::duration period_;
  Clock::time_point period_end_{};
  int passed_ = 0;
  std::uint64_t suppressed_ = 0;
  std::uint64_t summary_ = 0;
};

}  // namespace mpm::host
