#include "core/signal/interval_gap.hpp"

#include <catch2/catch.hpp>
#include <limits>

using mpm::missing_between;

TEST_CASE("intervals are missing between numbers that count on, and not between others") {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kLongest = mpm::calibration::alignment::kLongestGap;
  CHECK(missing_between(7, 8) == 0);
  CHECK(missing_between(7, 12) == 4);
  CHECK(missing_between(kMost - 3, kMost) == 2);
  CHECK(missing_between(12, 7) == 0);
  CHECK(missing_between(7, 7) == 0);
  CHECK(missing_between(0, kLongest) == static_cast<std::uint64_t>(kLongest) - 1);
  CHECK(missing_between(0, kLongest + 1) == 0);
  CHECK(missing_between(kLeast, kMost) == 0);
  CHECK(missing_between(kMost, kLeast) == 0);
}
