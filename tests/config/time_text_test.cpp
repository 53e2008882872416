#include "config/time_text.hpp"

#include <catch2/catch.hpp>

using mpm::config::parse_time;

TEST_CASE("times are seconds or ISO 8601") {
  CHECK(parse_time("0") == 0);
  CHECK(parse_time("1.5") == 1500000000);
  // date -u -d 2024-03-01T12:00:00Z +%s = 1709294400
  CHECK(parse_time("2024-03-01T12:00:00Z") == 1709294400000000000);
  CHECK(parse_time("2024-03-01T13:00:00.25+01:00") == 1709294400250000000);
  CHECK(parse_time("2024-03-01 06:30-0530") == 1709294400000000000);
  for (const char* bad :
       {"", "soon", "2024-03-01T12:00:00", "2024-13-01T12:00:00Z", "2023-02-29T12:00:00Z",
        "2024-03-01T25:00:00Z", "1e30", "nan", "2024-03-01T12:00:00Zx", "9999-12-31T23:59:59Z"})
    CHECK_FALSE(parse_time(bad).has_value());
}
