#include "daemon/report/moment_text.hpp"

#include <catch2/catch.hpp>

namespace mpm::report {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kNoon = 1'772'539'200 * kSecond;  // 2026-03-03T12:00:00Z

TEST_CASE("times are told in the zone that was asked for, and their year where it is another one") {
  const files::TimeZone zone("Asia/Kolkata");  // UTC+05:30, all the year
  const MomentText moment(kNoon, 60.0, &zone);
  CHECK(moment(kNoon) == "17:30 on 3 March");
  CHECK(moment(kNoon - 365 * 24 * 3600 * kSecond) == "17:30 on 3 March 2025");
  CHECK(moment.zone() == " (Asia/Kolkata)");
  CHECK(MomentText(kNoon, 1.0, nullptr)(kNoon + kSecond) == "12:00:01 on 3 March");
}

}  // namespace mpm::report
