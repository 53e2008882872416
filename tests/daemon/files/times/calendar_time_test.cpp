#include "daemon/files/times/calendar_time.hpp"

#include <catch2/catch.hpp>

using namespace mpm::files;

namespace {

// date -u -d '2026-03-28 14:05:00' +%s
constexpr std::int64_t kMarch28 = 1'774'706'700;

std::int64_t seconds(const std::string& text, DateOrder order = DateOrder::kUnknown) {
  CAPTURE(text);
  const auto time = parse_calendar(text);
  REQUIRE(time);
  const auto local = time->local(order);
  REQUIRE(local);
  return local->seconds;
}

}  // namespace

TEST_CASE("A time of the calendar is read however it is written") {
  for (const char* text :
       {"2026-03-28 14:05:00", "2026-03-28T14:05", "2026/3/28 14:05:00", "2026.03.28 14:05:00",
        "28.03.2026 14:05:00", "28.3.26 14:05", "28-Mar-26 14:05:00", "28-MAR-2026 14:05:00.000",
        "28 March 2026 14:05:00", "28/Mar/2026 14:05:00", "Mar 28, 2026 2:05 PM",
        "March 28 2026, 14:05", "28. M\xC3\xA4rz 2026 14:05", "28-Mrz-26 14:05:00",
        "2026-Mar-28 02:05:00 PM", "28-Mar-26  2:05:00 p.m.", "28.03.2026 14:05:00,000"})
    CHECK(seconds(text) == kMarch28);
  CHECK(seconds("28.03.2026") == kMarch28 - (14 * 3600 + 5 * 60));
  CHECK(seconds("12/31/1999 12:30 AM", DateOrder::kMonthFirst) == 946'600'200);
  CHECK(seconds("31-Dec-99 00:30", DateOrder::kUnknown) == 946'600'200);
  CHECK(parse_calendar("28.03.2026 14:05:00.25")->local(DateOrder::kUnknown)->fraction_ns ==
        250'000'000);
  CHECK(parse_calendar("28-Mar-26 14:05:00 +01:00")->zone_s == 3600);
  CHECK(parse_calendar("2026-03-28T14:05:00Z")->zone_s == 0);
  CHECK_FALSE(parse_calendar("2026-03-28T14:05:00")->zone_s);
}

TEST_CASE("Two numbers and a year need the order that they have") {
  for (const char* text : {"03/28/2026 14:05", "3/28/26 2:05 PM", "03-28-2026 14:05:00"})
    CHECK(seconds(text, DateOrder::kMonthFirst) == kMarch28);
  for (const char* text : {"28/03/2026 14:05", "28-03-26 14:05"})
    CHECK(seconds(text, DateOrder::kDayFirst) == kMarch28);
  CHECK_FALSE(parse_calendar("03/04/2026 14:05")->local(DateOrder::kUnknown));
  CHECK_FALSE(parse_calendar("28/03/2026 14:05")->local(DateOrder::kMonthFirst));
}

TEST_CASE("What is no time of the calendar is none") {
  for (const char* text :
       {"", "12.5", "1774706700", "46107.58", "14:05", "2026-03", "28.03 14:05", "28.03.2026 14",
        "28.03.2026 24:00", "28.03.2026 14:60", "28.03.2026 13:05 PM", "28-Mxx-26", "28.03.126",
        "28.03/2026", "2026-03-28Z", "28.03.2026 14:05 CET", "28.03.2026 14:05:00."}) {
    CAPTURE(text);
    CHECK_FALSE(parse_calendar(text));
  }
  CHECK_FALSE(parse_calendar("30.02.2026 14:05")->local(DateOrder::kUnknown));
}

TEST_CASE("A format is proposed for a date that may be read either way") {
  CHECK(format_like("03/04/2026 14:05:00", DateOrder::kDayFirst) == "%d/%m/%Y %H:%M:%S");
  CHECK(format_like("3-4-26 2:05 PM", DateOrder::kMonthFirst) == "%m-%d-%y %I:%M %p");
  CHECK(format_like("03/04/2026", DateOrder::kMonthFirst) == "%m/%d/%Y");
}
