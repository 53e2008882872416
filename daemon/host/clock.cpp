#include "daemon/host/clock.hpp"

#include <chrono>
#include <thread>

namespace mpm::host {

std::int64_t SteadyClock::now() const {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void SteadyClock::sleep_until(std::int64_t time) {
  std::this_thread::sleep_until(
      std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time)));
}

ArrivalClock::ArrivalClock()
    : since_1970_ns_(
          std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count() -
          steady_.now()) {}

}  // namespace mpm::host
