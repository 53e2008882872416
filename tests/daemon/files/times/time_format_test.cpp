#include "daemon/files/times/time_format.hpp"

#include <catch2/catch.hpp>

#include "config/finding.hpp"

using namespace mpm;
using namespace mpm::files;

namespace {

std::int64_t seconds(const std::string& format, const std::string& text) {
  CAPTURE(format, text);
  const auto time = TimeFormat(format).parse(text);
  REQUIRE(time);
  return time->local(DateOrder::kUnknown)->seconds;
}

}  // namespace

TEST_CASE("Times are read as a format says") {
  constexpr std::int64_t kMarch28 = 1'774'706'700;  // date -u -d '2026-03-28 14:05:00' +%s
  CHECK(seconds("%d/%m/%Y %H:%M", "28/03/2026 14:05") == kMarch28);
  CHECK(seconds("%Y%m%d%H%M%S", "20260328140500") == kMarch28);
  CHECK(seconds("%Y%m%dT%H%M%S", "20260328T140500") == kMarch28);
  CHECK(seconds("%H:%M %e. %B %y", "14:05  28. M\xC3\xA4rz 26") == kMarch28);
  CHECK(seconds("%D %I:%M:%S%p", "03/28/26 2:05:00PM") == kMarch28);
  CHECK(seconds("%F %T", "2026-03-28 14:05:00.5") == kMarch28);
  CHECK(seconds("%y.%j %R", "26.87 14:05") == kMarch28);  // 31 + 28 + 28
  CHECK(seconds("%d.%m.%Y %H:%M:%S CET", "28.03.2026 14:05:00 CET") == kMarch28);
  CHECK(seconds("%a %b %d %H:%M:%S %Z %Y", "Sat Mar 28 14:05:00 CET 2026") == kMarch28);
  CHECK(seconds("%s", "1774706700.25") == kMarch28);
  CHECK(TimeFormat("%s").parse("1774706700.25")->fraction_ns == 250'000'000);
  CHECK(TimeFormat("%s").parse("1")->zone_s == 0);
  CHECK(TimeFormat("%F %T%z").parse("2026-03-28 15:05:00+0100")->zone_s == 3600);
  CHECK(TimeFormat("%d/%m/%Y").parse("28/03/2026")->second_of_day == 0);
}

TEST_CASE("What is written otherwise is no time") {
  const TimeFormat format("%d/%m/%Y %H:%M");
  for (const char* text : {"", "28/03/2026", "28/03/2026 14:05:00", "28.03.2026 14:05",
                           "28/03/26 14:05", "28/03/2026 25:05"}) {
    CAPTURE(text);
    CHECK_FALSE(format.parse(text));
  }
}

TEST_CASE("A format that tells no day is refused, as one with unknown letters is") {
  CHECK_THROWS_WITH(TimeFormat("%H:%M"), Catch::Contains("does not tell year, month and day"));
  CHECK_THROWS_WITH(TimeFormat("dd.mm.yyyy"),
                    Catch::Contains("--time-format") && Catch::Contains("'%d.%m.%Y %H:%M:%S'"));
  CHECK_THROWS_WITH(TimeFormat("%d.%m.%Y %Q"), Catch::Contains("has %Q; known are"));
  CHECK_THROWS_AS(TimeFormat("%d.%m.%"), config::InputError);
}
