#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mpm::files {

class Cursor;

/// What a clock showed, of which only its zone tells the moment.
struct LocalTime {
  std::int64_t seconds = 0;  ///< since 1970, counted as if it were UTC
  std::int64_t fraction_ns = 0;
};

/// Of a date of two numbers and a year, 03/04/2026, or of three numbers, 26/03/04: what only the
/// whole file can tell. The year comes first or last.
enum class DateOrder { kUnknown, kDayFirst, kMonthFirst, kYearFirst };

/// What comes first: "day", "month", "year"; empty where that is unknown.
[[nodiscard]] const char* name_of(DateOrder order);

/// A date and a time of day as they are written.
struct CalendarTime {
  int year = 0, month = 0, day = 0;
  /// `month` and `day` are two numbers as they stand, of which nothing tells which is which.
  bool two_numbers = false;
  /// The year too is two digits, the last ones: the year may come first (`month`) and the day last.
  bool short_year = false;
  int second_of_day = 0;  ///< up to 86400, where it is written as 24:00
  std::int64_t fraction_ns = 0;
  std::optional<int> zone_s;  ///< east of UTC, where it is written

  /// Where `order` is needed and known; nothing too where there is no such day.
  [[nodiscard]] std::optional<LocalTime> local(DateOrder order) const;
};

/// Year, month and day as numbers or with the month's name (English, German, French, Spanish,
/// Italian), the year first or last and of two digits too (70 to 69: 1970 to 2069); dots put the
/// day first. Then the time of day, 24 hours (24:00 is the next day's 0:00) or AM/PM, with
/// fractions or without seconds, or none: midnight; also 20260328T140500. Then a zone: `Z`, `UTC`,
/// `+hh:mm`, or none. Nothing for any other text.
[[nodiscard]] std::optional<CalendarTime> parse_calendar(std::string_view text);

/// A month by its name or the beginning of it, in one of these languages, 1 to 12; else 0.
[[nodiscard]] int month_of(std::string_view name);
/// The year that two digits stand for.
[[nodiscard]] int full_year(int two_digits);
/// Seconds east of UTC up to the end of the text, or nothing where there is no zone.
[[nodiscard]] std::optional<int> take_zone(Cursor& cursor);
/// Digits behind a decimal point, in ns.
[[nodiscard]] std::int64_t fraction_ns_of(std::string_view digits);

/// How such a text would be described in letters of strftime.
[[nodiscard]] std::string format_like(std::string_view text, DateOrder order);

}  // namespace mpm::files
