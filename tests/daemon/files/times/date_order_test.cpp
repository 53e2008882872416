#include "daemon/files/times/date_order.hpp"

#include <catch2/catch.hpp>

using namespace mpm::files;

namespace {

DateOrder order_of(const std::vector<std::string>& texts) {
  DateOrderFinder finder;
  for (const std::string& text : texts) {
    const auto time = parse_calendar(text);
    REQUIRE(time);
    finder.add(*time, "");
  }
  return finder.order();
}

}  // namespace

TEST_CASE("A number above twelve tells the order of the whole file") {
  CHECK(order_of({"03/04/2026 1:00", "03/13/2026 1:00"}) == DateOrder::kMonthFirst);
  CHECK(order_of({"03/04/2026 1:00", "13/04/2026 1:00"}) == DateOrder::kDayFirst);
}

TEST_CASE("Only one order may let time go on") {
  // 31 January to 1 February day first; month first it would go back from December to January.
  CHECK(order_of({"12/01/2026 23:59", "01/02/2026 0:00"}) == DateOrder::kDayFirst);
  CHECK(order_of({"01/12/2026 23:59", "02/01/2026 0:00"}) == DateOrder::kMonthFirst);
}

TEST_CASE("Only one order may let the days follow one another") {
  CHECK(order_of({"03/04/2026 23:59", "03/05/2026 0:00"}) == DateOrder::kMonthFirst);
  CHECK(order_of({"04/03/2026 23:59", "05/03/2026 0:00"}) == DateOrder::kDayFirst);
}

TEST_CASE("Two digits at the front may be the year") {
  CHECK(order_of({"26/03/28 10:00", "26/03/29 10:00"}) == DateOrder::kYearFirst);
  CHECK(order_of({"26-03-31 23:59", "26-04-01 0:00"}) == DateOrder::kYearFirst);
  CHECK(order_of({"99/03/28 10:00"}) == DateOrder::kYearFirst);  // no day, no month is 99
  CHECK(order_of({"28/03/26 10:00", "29/03/26 10:00"}) == DateOrder::kDayFirst);
  CHECK(order_of({"03/28/26 10:00", "03/29/26 10:00"}) == DateOrder::kMonthFirst);
  CHECK(order_of({"10/11/12 10:00", "10/11/13 10:00"}) == DateOrder::kYearFirst);
  CHECK(order_of({"26/03/27 10:00", "26/03/30 10:00"}) == DateOrder::kYearFirst);  // a weekend
  CHECK(order_of({"27/03/26 10:00", "30/03/26 10:00"}) == DateOrder::kDayFirst);
  CHECK(order_of({"26.03.28 10:00", "26.03.29 10:00"}) == DateOrder::kUnknown);  // dots: day first
}

TEST_CASE("A year that may be at either end is taken to be at the end, and told") {
  DateOrderFinder finder;
  finder.add(*parse_calendar("26/03/28 10:00"), "");
  finder.add(*parse_calendar("26/03/28 11:00"), "");
  CHECK(finder.order() == DateOrder::kDayFirst);
  CHECK(finder.notice().find("two digits at the end are taken for the year") != std::string::npos);
  CHECK(order_of({"10/11/12 10:00"}) == DateOrder::kUnknown);  // any of three
  DateOrderFinder with_century;
  with_century.add(*parse_calendar("26/03/2028 10:00"), "");
  CHECK(with_century.settled());
  CHECK(with_century.notice().empty());
}

TEST_CASE("What is no date in any order tells nothing") {
  CHECK(order_of({"31/02/2026 10:00", "03/13/2026 10:00"}) == DateOrder::kMonthFirst);
  CHECK(order_of({"31/02/2026 10:00"}) == DateOrder::kUnknown);
}

TEST_CASE("One day alone tells nothing") {
  CHECK(order_of({"03/04/2026 14:05", "03/04/2026 14:06"}) == DateOrder::kUnknown);
  CHECK(order_of({"03/04/2026 14:05", "03/04/2026 12:05"}) == DateOrder::kUnknown);  // goes back
  CHECK(order_of({"04/04/2026 14:05"}) == DateOrder::kUnknown);
}

TEST_CASE("An hour that clocks go back is no going back") {
  // The night to 1 November 2026 in the United States, month first.
  CHECK(order_of({"11/01/2026 1:59", "11/01/2026 1:00", "11/02/2026 0:00"}) ==
        DateOrder::kMonthFirst);
}

TEST_CASE("Series are followed by themselves") {
  DateOrderFinder finder;
  for (const char* tag : {"a", "b"})  // a file sorted by tag goes back where the next begins
    for (const char* text : {"03/04/2026 23:59", "03/05/2026 0:00"})
      finder.add(*parse_calendar(text), tag);
  CHECK(finder.order() == DateOrder::kMonthFirst);
  CHECK(finder.notice().find("month first") != std::string::npos);
  finder.add(*parse_calendar("2026-01-01 0:00"), "a");  // another way of writing tells nothing
  CHECK_FALSE(finder.settled());
}
