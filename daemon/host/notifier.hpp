#pragma once

#include <chrono>
#include <string>

namespace mpm::host {

/// Tells systemd how the service is; does nothing where there is no systemd. The watchdog is fed
/// from the event loop, so that a hung loop is noticed.
class Notifier {
 public:
  using Clock = std::chrono::steady_clock;

  Notifier();
  void ready() const;
  /// Until ready() again.
  void reloading() const;
  void stopping() const;
  void status(const std::string& text);
  /// Stands behind every status from now on; of several lines the first.
  void remark(const std::string& text);
  void feed_watchdog(Clock::time_point now);

 private:
  Clock::duration watchdog_period_{};  // zero: none asked for
  Clock::time_point next_feed_{};
  std::string last_status_;
  std::string remark_;
};

}  // namespace mpm::host
