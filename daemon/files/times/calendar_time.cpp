#include "daemon/files/times/calendar_time.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "daemon/files/times/cursor.hpp"

namespace mpm::files {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string lower(std::string_view text) {
  std::string result(text);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto code = static_cast<unsigned char>(result[i]);
    const bool accented = i > 0 && result[i - 1] == '\xC3' && code >= 0x80 && code <= 0x9E;
    result[i] = accented ? static_cast<char>(code + 0x20) : lower(result[i]);
  }
  return result;
}

bool is_separator(char c) { return c == '-' || c == '/' || c == '.'; }

/// Blanks, or a sign with blanks behind it; '\0' where a name stands next to a number.
char take_separator(Cursor& cursor) {
  const bool blank = cursor.peek() == ' ';
  cursor.take_blanks();
  const char sign = cursor.peek();
  if (!is_separator(sign) && sign != ',') return blank ? ' ' : '\0';
  cursor.take(sign);
  cursor.take_blanks();
  return sign;
}

int take_month(Cursor& cursor) {
  if (Cursor::is_digit(cursor.peek())) return cursor.take_number(1, 2);
  const int month = month_of(cursor.take_letters());
  Cursor ahead = cursor;  // the dot of janv. belongs to it, where a sign comes behind
  if (ahead.take('.') && !ahead.done() && !Cursor::is_digit(ahead.peek())) cursor = ahead;
  return month == 0 ? -1 : month;
}

int take_year(Cursor& cursor) {
  const std::string_view digits = cursor.take_digits(4);
  if (digits.size() == 4) return Cursor(digits).take_number(4);
  return digits.size() == 2 ? full_year(Cursor(digits).take_number(2)) : -1;
}

bool fill(CalendarTime& time, int year, int month, int day) {
  time.year = year;
  time.month = month;
  time.day = day;
  return year >= 0 && month >= 0 && day >= 0;
}

/// 20260328 before a time of day; alone it is a number.
bool take_compact_date(Cursor& cursor, CalendarTime& time) {
  Cursor ahead = cursor;
  const std::string_view digits = ahead.take_digits();
  if (digits.size() != 8 || (ahead.peek() != ' ' && ahead.peek() != 'T' && ahead.peek() != 't'))
    return false;
  const auto number = [&digits](std::size_t from, std::size_t count) {
    return Cursor(digits.substr(from, count)).take_number(count);
  };
  cursor = ahead;
  return fill(time, number(0, 4), number(4, 2), number(6, 2));
}

/// 2026-03-28, 2026/3/28, 28.03.2026, 28-Mar-26, Mar 28, 2026, and what may be either order.
bool take_date(Cursor& cursor, CalendarTime& time) {
  if (!Cursor::is_digit(cursor.peek())) {
    const int month = take_month(cursor);
    if (month < 0 || take_separator(cursor) == '\0') return false;
    const int day = cursor.take_number(1, 2);
    if (take_separator(cursor) == '\0') return false;
    return fill(time, take_year(cursor), month, day);
  }
  const std::string_view digits = cursor.take_digits(4);
  const int first = Cursor(digits).take_number(1, 4);
  const char separator = take_separator(cursor);
  if (separator == ',' || digits.size() == 3) return false;
  if (digits.size() == 4) {
    if (!is_separator(separator)) return false;
    const int month = take_month(cursor);
    if (take_separator(cursor) != separator) return false;
    return fill(time, first, month, cursor.take_number(1, 2));
  }
  const bool named = !Cursor::is_digit(cursor.peek());
  if (!named && !is_separator(separator)) return false;
  const int month = take_month(cursor);
  const char second = take_separator(cursor);
  if (named ? second == '\0' : second != separator) return false;
  if (!named && separator != '.') {
    time.two_numbers = true;
    const std::size_t before = cursor.rest().size();
    const int year = take_year(cursor);
    time.short_year = before - cursor.rest().size() == 2;
    return fill(time, year, first, month);
  }
  return fill(time, take_year(cursor), month, first);
}

/// AM or PM, `a.m.` too; nothing where there is neither.
std::optional<bool> take_afternoon(Cursor& cursor) {
  Cursor ahead = cursor;
  ahead.take_blanks();
  const char letter = lower(ahead.peek());
  if (letter != 'a' && letter != 'p') return std::nullopt;
  ahead.take(ahead.peek());
  ahead.take('.');
  if (!ahead.take('m') && !ahead.take('M')) return std::nullopt;
  ahead.take('.');
  cursor = ahead;
  return letter == 'p';
}

/// 14:05[:00[.25]], 2:05 PM; behind a compact date 1405[00[.25]] too. 24:00 ends a day.
bool take_clock(Cursor& cursor, bool compact, CalendarTime& time) {
  int hour = cursor.take_number(1, 2);
  const bool colons = cursor.take(':');
  if (hour < 0 || (!colons && !compact)) return false;
  const int minute = cursor.take_number(2);
  int second = 0;
  if (colons ? cursor.take(':') : Cursor::is_digit(cursor.peek())) {
    second = cursor.take_number(2);
    if (cursor.take('.') || cursor.take(',')) {
      const std::string_view digits = cursor.take_digits();
      if (digits.empty()) return false;
      time.fraction_ns = fraction_ns_of(digits);
    }
  }
  if (const std::optional<bool> afternoon = take_afternoon(cursor)) {
    if (hour < 1 || hour > 12) return false;
    hour = hour % 12 + (*afternoon ? 12 : 0);
  }
  if (hour > 24 || minute < 0 || minute > 59 || second < 0 || second > 60)  // 60 = leap second
    return false;
  if (hour == 24 && (minute > 0 || second > 0 || time.fraction_ns > 0)) return false;
  time.second_of_day = 3600 * hour + 60 * minute + second;
  return true;
}

}  // namespace

const char* name_of(DateOrder order) {
  switch (order) {
    case DateOrder::kDayFirst:
      return "day";
    case DateOrder::kMonthFirst:
      return "month";
    case DateOrder::kYearFirst:
      return "year";
    case DateOrder::kUnknown:
      break;
  }
  return "";
}

std::optional<LocalTime> CalendarTime::local(DateOrder order) const {
  if (two_numbers && order == DateOrder::kUnknown) return std::nullopt;
  int y = year, m = month, d = day;
  if (two_numbers && order == DateOrder::kDayFirst) std::swap(m, d);
  if (two_numbers && order == DateOrder::kYearFirst) {
    if (!short_year) return std::nullopt;
    y = full_year(month);
    m = day;
    d = year % 100;
  }
  const std::chrono::year_month_day date{std::chrono::year(y),
                                         std::chrono::month(static_cast<unsigned>(m)),
                                         std::chrono::day(static_cast<unsigned>(d))};
  if (!date.ok()) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return LocalTime{86400 * days + second_of_day, fraction_ns};
}

std::optional<CalendarTime> parse_calendar(std::string_view text) {
  Cursor cursor(text);
  CalendarTime time;
  const bool compact = take_compact_date(cursor, time);
  if (!compact && !take_date(cursor, time)) return std::nullopt;
  if (cursor.done()) return time;
  cursor.take(',');
  if (cursor.peek() != ' ' && cursor.peek() != 'T' && cursor.peek() != 't') return std::nullopt;
  cursor.take(cursor.peek());
  cursor.take_blanks();
  if (!take_clock(cursor, compact, time)) return std::nullopt;
  if (cursor.done()) return time;
  time.zone_s = take_zone(cursor);
  return time.zone_s ? std::optional(time) : std::nullopt;
}

int month_of(std::string_view name) {
  // English, German, French, Spanish, Italian, none of which has another one's month under its
  // name.
  static constexpr std::pair<std::string_view, int> kMonths[] = {
      {"jan", 1},        {"ene", 1},  {"gen", 1},  {"feb", 2},        {"fev", 2},
      {"f\xC3\xA9v", 2}, {"mar", 3},  {"mrz", 3},  {"m\xC3\xA4r", 3}, {"apr", 4},
      {"avr", 4},        {"abr", 4},  {"may", 5},  {"mai", 5},        {"mag", 5},
      {"jun", 6},        {"juin", 6}, {"giu", 6},  {"jul", 7},        {"juil", 7},
      {"lug", 7},        {"aug", 8},  {"aou", 8},  {"ao\xC3\xBB", 8}, {"ago", 8},
      {"sep", 9},        {"set", 9},  {"oct", 10}, {"okt", 10},       {"ott", 10},
      {"nov", 11},       {"dec", 12}, {"dez", 12}, {"dic", 12},       {"d\303\251c", 12}};
  const std::string text = lower(name);
  for (const auto& [beginning, month] : kMonths)
    if (text.starts_with(beginning)) return month;
  return 0;
}

int full_year(int two_digits) { return two_digits + (two_digits < 70 ? 2000 : 1900); }

std::optional<int> take_zone(Cursor& cursor) {
  cursor.take_blanks();
  if (cursor.take('Z') || cursor.take('z') || cursor.take_word("UTC") || cursor.take_word("GMT"))
    return cursor.done() ? std::optional<int>(0) : std::nullopt;
  const bool west = cursor.take('-');
  if (!west && !cursor.take('+')) return std::nullopt;
  const int hours = cursor.take_number(2);
  cursor.take(':');
  const int minutes = cursor.done() ? 0 : cursor.take_number(2);
  if (hours < 0 || hours > 14 || minutes < 0 || minutes > 59 || !cursor.done()) return std::nullopt;
  const int seconds = 3600 * hours + 60 * minutes;
  return west ? -seconds : seconds;
}

std::int64_t fraction_ns_of(std::string_view digits) {
  std::int64_t value = 0;
  for (std::size_t i = 0; i < 9; ++i)
    value = 10 * value + (i < digits.size() ? digits[i] - '0' : 0);
  return digits.size() > 9 && digits[9] >= '5' ? value + 1 : value;
}

std::string format_like(std::string_view text, DateOrder order) {
  Cursor cursor(text);
  cursor.take_digits();
  const char separator = cursor.peek();
  cursor.take(separator);
  cursor.take_digits();
  cursor.take(separator);
  const std::string year = cursor.take_digits().size() == 4 ? "%Y" : "%y";
  std::string format = order == DateOrder::kDayFirst     ? "%d@%m@" + year
                       : order == DateOrder::kMonthFirst ? "%m@%d@" + year
                                                         : year + "@%m@%d";
  std::replace(format.begin(), format.end(), '@', separator);
  if (cursor.done()) return format;
  const bool half_day = text.back() == 'M' || text.back() == 'm';
  const std::size_t seconds = text.find(':', text.find(':') + 1);
  return format + (half_day ? " %I:%M" : " %H:%M") +
         (seconds != std::string_view::npos ? ":%S" : "") + (half_day ? " %p" : "");
}

}  // namespace mpm::files
