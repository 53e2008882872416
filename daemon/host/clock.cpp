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

std::int64_t wall_time_ns() {
  return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace mpm::host
