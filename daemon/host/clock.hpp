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

/// UTC as it was when this was made, carried on by the steady clock: what is stamped with it keeps
/// its order and its distances when somebody sets the machine's clock.
class ArrivalClock {
 public:
  ArrivalClock();
  /// ns since 1970; never goes back.
  [[nodiscard]] std::int64_t now_ns() const { return since_1970_ns_ + steady_.now(); }

 private:
  SteadyClock steady_;
  std::int64_t since_1970_ns_;  ///< to the beginning of the steady clock
};

}  // namespace mpm::host
