#include "daemon/host/rate_limiter.hpp"

#include <catch2/catch.hpp>

namespace mpm::host {

TEST_CASE("of many messages a few pass per period; the next period tells how many did not") {
  using namespace std::chrono_literals;
  RateLimiter limiter(3, 10s);
  const RateLimiter::Clock::time_point start{1h};
  int passed = 0;
  for (int i = 0; i < 100; ++i) passed += limiter.admit(start + i * 1ms) ? 1 : 0;
  CHECK(passed == 3);
  CHECK(limiter.admit(start + 11s));
  CHECK(limiter.held_back() == 97);
  CHECK(limiter.admit(start + 12s));
  CHECK(limiter.held_back() == 0);
}

}  // namespace mpm::host
