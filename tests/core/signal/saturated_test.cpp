#include "core/signal/saturated.hpp"

#include <catch2/catch.hpp>

using mpm::saturated_difference;
using mpm::saturated_sum;

TEST_CASE("sums and differences that int64 does not hold stop at its ends") {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  CHECK(saturated_sum(2, 3) == 5);
  CHECK(saturated_sum(kMost, 1) == kMost);
  CHECK(saturated_sum(kLeast, -1) == kLeast);
  CHECK(saturated_sum(kMost, kLeast) == -1);
  CHECK(saturated_difference(2, 3) == -1);
  CHECK(saturated_difference(kMost, -1) == kMost);
  CHECK(saturated_difference(kLeast, 1) == kLeast);
  CHECK(saturated_difference(-1, kLeast) == kMost);
}
