#include "daemon/host/notifier.hpp"

#include <systemd/sd-daemon.h>

#include <cstdint>

namespace mpm::host {

Notifier::Notifier() {
  std::uint64_t timeout_us = 0;
  if (sd_watchdog_enabled(0, &timeout_us) > 0)
    watchdog_period_ = std::chrono::microseconds(timeout_us) / 3;
}

void Notifier::ready() const { sd_notify(0, "READY=1"); }

void Notifier::stopping() const { sd_notify(0, "STOPPING=1"); }

void Notifier::reloading() const { sd_notify(0, "RELOADING=1"); }

void Notifier::status(const std::string& text) {
  const std::string whole = remark_.empty() ? text : text + "; " + remark_;
  if (whole == last_status_) return;
  last_status_ = whole;
  sd_notify(0, ("STATUS=" + whole).c_str());
}

// A line of its own would be another notification.
void Notifier::remark(const std::string& text) { remark_ = text.substr(0, text.find('\n')); }

void Notifier::feed_watchdog(Clock::time_point now) {
  if (watchdog_period_ == Clock::duration::zero() || now < next_feed_) return;
  sd_notify(0, "WATCHDOG=1");
  next_feed_ = now + watchdog_period_;
}

}  // namespace mpm::host
