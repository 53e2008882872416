#include "daemon/files/times/time_text.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace mpm;
using namespace mpm::files;

namespace {

std::int64_t ns(const std::string& text) {
  std::string problem;
  const auto time = parse_time(text, problem);
  CAPTURE(text, problem);
  REQUIRE(time);
  return *time;
}

bool is_time(const std::string& text) {
  std::string problem;
  return parse_time(text, problem).has_value();
}

}  // namespace

TEST_CASE("Seconds are exact to the nanosecond") {
  CHECK(ns("0") == 0);
  CHECK(ns("0.08") == 80'000'000);
  CHECK(ns("0,08") == 80'000'000);
  CHECK(ns("-1.5") == -1'500'000'000);
  CHECK(ns("+2.") == 2'000'000'000);
  CHECK(ns(".5") == 500'000'000);
  CHECK(ns("1e3") == 1'000'000'000'000);
  CHECK(ns("1.25E-3") == 1'250'000);
  // A double holds today's seconds only to about 200 ns.
  CHECK(ns("1714564800.123456789") == 1'714'564'800'123'456'789);
  CHECK(ns("0.0000000004") == 0);
  CHECK(ns("0.0000000005") == 1);
  CHECK(ns("0.1234567894999") == 123'456'789);
  CHECK(ns("000000000000000000000000001") == 1'000'000'000);
  CHECK(ns("1e-999") == 0);
  for (const char* text : {"", "-", ".", "1e", "1e+", "nan", "inf", "0x10", "1 2", "1e9999", "1e12",
                           "99999999999999999999", "12:00"})
    CHECK_FALSE(is_time(text));
}

TEST_CASE("Numbers that lie in our time in one unit are read in that unit, fractions too") {
  struct Written {
    const char* text;
    std::int64_t time_ns;
    const char* unit;
  };
  for (const Written& written :
       {Written{"1714564800000", 1'714'564'800'000'000'000, "milliseconds"},
        Written{"1714564800250.0", 1'714'564'800'250'000'000, "milliseconds"},  // a double's text
        Written{"1714564800250.125", 1'714'564'800'250'125'000, "milliseconds"},
        Written{"1714564800000250.5", 1'714'564'800'000'250'500, "microseconds"},
        Written{"1714564800000000250", 1'714'564'800'000'000'250, "nanoseconds"}}) {
    CAPTURE(written.text);
    const auto epoch = parse_epoch(written.text);
    REQUIRE(epoch);
    CHECK(epoch->time_ns == written.time_ns);
    CHECK(std::string(epoch->unit) == written.unit);
  }
  for (const char* text : {"1714564800", "1714564800.5", "1714564800000.5x", "1714564800000.5.5"})
    CHECK_FALSE(parse_epoch(text));
}

TEST_CASE("ISO 8601 times with a zone are UTC") {
  CHECK(ns("1970-01-01T00:00:00Z") == 0);
  // date -u -d 2024-05-01T12:00:00Z +%s
  constexpr std::int64_t kMay = 1'714'564'800'000'000'000;
  CHECK(ns("2024-05-01T12:00:00Z") == kMay);
  CHECK(ns("2024-05-01 12:00:00Z") == kMay);
  CHECK(ns("2024-05-01T12:00Z") == kMay);
  CHECK(ns("2024-05-01T14:00:00+02:00") == kMay);
  CHECK(ns("2024-05-01T14:00:00+0200") == kMay);
  CHECK(ns("2024-05-01T06:30:00-05:30") == kMay);
  CHECK(ns("2024-05-01 12:00:00 UTC") == kMay);
  CHECK(ns("2024-05-01T12:00:00.25Z") == kMay + 250'000'000);
  CHECK(ns("2024-05-01T12:00:00,123456789Z") == kMay + 123'456'789);
  CHECK(ns("2024-02-29T00:00:00Z") == 1'709'164'800'000'000'000);
  CHECK(ns("1969-12-31T23:59:59Z") == -1'000'000'000);
  for (const char* text :
       {"2024-05-01", "2024-05-01T12:00:00", "2023-02-29T00:00:00Z", "2024-13-01T00:00:00Z",
        "2024-05-01T24:00:01Z", "2024-05-01T12:60:00Z", "2024-05-01T12:00:00X",
        "2024-05-01T12:00:00+25:00", "2024-05-01T12:00:00Zx", "9999-05-01T12:00:00Z",
        "2024-05-01T12:00:00.Z"})
    CHECK_FALSE(is_time(text));
}

TEST_CASE("Every time that int64 holds has a text") {
  // Python: datetime(1970, 1, 1) + timedelta(microseconds=...), and the digits after them.
  CHECK(utc_text(std::numeric_limits<std::int64_t>::min()) == "1677-09-21T00:12:43.145224192Z");
  CHECK(utc_text(std::numeric_limits<std::int64_t>::max()) == "2262-04-11T23:47:16.854775807Z");
  CHECK(utc_text(-1) == "1969-12-31T23:59:59.999999999Z");
}
