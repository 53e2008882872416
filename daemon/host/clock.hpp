#pragma once

#include <cstdint>

namespace mpm::host {

/// The only time that recording and replay know; tests bring their own.
class Clock {
 public:
  Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  virtual ~Clock() = default;

  /// ns since some fixed moment; never goes back.
  [[nodiscard]] virtual std::int64_t now() const = 0;
  /// Returns at `time` or, at the caller's risk, earlier.
  virtual void sleep_until(std::int64_t time) = 0;
};

/// The machine's steady clock.
class SteadyClock : public Clock {
 public:
  [[nodiscard]] std::int64_t now() const override;
  void sleep_until(std::int64_t time) override;
};

/// ns of UTC since 1970, for time stamps only.
[[nodiscard]] std::int64_t wall_time_ns();

}  // namespace mpm::host
