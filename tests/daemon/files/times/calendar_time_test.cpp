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
  for (const char* text : {"2026-03-28 14:05:00",
                           "2026-03-28T14:05",
                           "2026/3/28 14:05:00",
                           "2026.03.28 14:05:00",
                           "28.03.2026 14:05:00",
                           "28.3.26 14:05",
                           "28-Mar-26 14:05:00",
                           "28-MAR-2026 14:05:00.000",
                           "28 March 2026 14:05:00",
                           "28/Mar/2026 14:05:00",
                           "Mar 28, 2026 2:05 PM",
                           "March 28 2026, 14:05",
                           "28. M\xC3\xA4rz 2026 14:05",
                           "28-Mrz-26 14:05:00",
                           "2026-Mar-28 02:05:00 PM",
                           "28 mars 2026 14:05",
                           "28-MARS-26 14:05",
                           "28 marzo 2026 14:05",
                           "20260328T1405",
                           "20260328T140500",
                           "20260328 14:05:00.0",
                           "28-Mar-26  2:05:00 p.m.",
                           "28.03.2026 14:05:00,000"})
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

TEST_CASE("24:00 is the end of its day") {
  const std::int64_t midnight = kMarch28 - (14 * 3600 + 5 * 60);
  CHECK(seconds("27.03.2026 24:00") == midnight);
  CHECK(seconds("2026-03-27T24:00:00Z") == midnight);
  CHECK(seconds("20251231T2400") == seconds("2026-01-01"));
}

TEST_CASE("Months have their names in five languages") {
  const char* const kYears[][12] = {
      {"janv.", "f\xC3\xA9vr.", "mars", "avr.", "mai", "juin", "juil.", "ao\xC3\xBBt", "sept.",
       "oct.", "nov.", "d\303\251c."},
      {"ene", "feb", "mar", "abr", "may", "jun", "jul", "ago", "set", "oct", "nov", "dic"},
      {"gennaio", "febbraio", "marzo", "aprile", "maggio", "giugno", "luglio", "agosto",
       "settembre", "ottobre", "novembre", "dicembre"},
      {"Jan.", "Feb.", "M\xC3\x84RZ", "Apr.", "Mai", "Juni", "Juli", "Aug.", "Sep.", "Okt.", "Nov.",
       "Dez."},
      {"January", "February", "March", "April", "May", "June", "July", "August", "September",
       "October", "November", "December"}};
  for (const auto& names : kYears)
    for (int month = 1; month <= 12; ++month) {
      const std::string name = names[month - 1];
      for (const std::string& text : {"3 " + name + " 2026 14:05", "3-" + name + "-26 14:05"}) {
        CAPTURE(text);
        const auto time = parse_calendar(text);
        REQUIRE(time);
        CHECK(time->month == month);
      }
    }
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
  for (const char* text : {"",
                           "12.5",
                           "1774706700",
                           "46107.58",
                           "14:05",
                           "2026-03",
                           "28.03 14:05",
                           "28.03.2026 14",
                           "28.03.2026 24:01",
                           "28.03.2026 24:00:01",
                           "28.03.2026 24:00:00.5",
                           "20260328",
                           "20260328T14",
                           "2026032T1405",
                           "20260328140500",
                           "28.03.2026 1405",
                           "28.03.2026 14:60",
                           "28.03.2026 13:05 PM",
                           "28-Mxx-26",
                           "28.03.126",
                           "28.03/2026",
                           "2026-03-28Z",
                           "28.03.2026 14:05 CET",
                           "28.03.2026 14:05:00."}) {
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
