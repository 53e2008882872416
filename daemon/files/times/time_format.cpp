#include "daemon/files/times/time_format.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "config/finding.hpp"
#include "core/signal/nanoseconds.hpp"
#include "daemon/files/times/cursor.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::files {
namespace {

constexpr std::int64_t kDay = 86400;
constexpr std::string_view kLetters = "YymbBdeHIMSpzZaAjs%";

/// What the letters gave so far; -1 = nothing.
struct Parts {
  int year = -1, month = -1, day = -1, day_of_year = -1;
  int hour = 0, hour_of_half = -1, minute = 0, second = 0;
  std::optional<bool> afternoon;
  CalendarTime time;   ///< fraction and zone
  bool whole = false;  ///< `time` is all, from seconds since 1970
};

void set_date(CalendarTime& time, std::chrono::sys_days day) {
  const std::chrono::year_month_day date(day);
  time.year = static_cast<int>(date.year());
  time.month = static_cast<int>(static_cast<unsigned>(date.month()));
  time.day = static_cast<int>(static_cast<unsigned>(date.day()));
}

bool take_fraction(Cursor& cursor, CalendarTime& time) {
  Cursor ahead = cursor;
  if (!ahead.take('.') && !ahead.take(',')) return true;
  const std::string_view digits = ahead.take_digits();
  if (digits.empty()) return true;
  time.fraction_ns = fraction_ns_of(digits);
  cursor = ahead;
  return true;
}

bool take_half(Cursor& cursor, Parts& parts) {
  const std::string_view word = cursor.take_letters();
  if (word.size() != 2 || (word[1] != 'M' && word[1] != 'm')) return false;
  const bool morning = word[0] == 'A' || word[0] == 'a';
  if (!morning && word[0] != 'P' && word[0] != 'p') return false;
  parts.afternoon = !morning;
  return true;
}

bool take_seconds_since_1970(Cursor& cursor, Parts& parts) {
  std::string problem;
  std::string_view number = cursor.rest();
  while (!number.empty() && !Cursor::is_digit(number.back())) number.remove_suffix(1);
  const std::optional<std::int64_t> time_ns = parse_seconds(number, problem);
  if (!time_ns) return false;
  const std::chrono::sys_time<std::chrono::nanoseconds> moment{std::chrono::nanoseconds(*time_ns)};
  const auto day = std::chrono::floor<std::chrono::days>(moment);
  set_date(parts.time, day);
  const std::int64_t rest_ns = (moment - day).count();
  parts.time.second_of_day = static_cast<int>(rest_ns / kSecondNs);
  parts.time.fraction_ns = rest_ns % kSecondNs;
  parts.time.zone_s = 0;
  parts.whole = true;
  return cursor.take_word(number);
}

bool take_zone_letters(Cursor& cursor, CalendarTime& time) {
  std::string_view zone = cursor.rest();
  zone = zone.substr(0, zone.find_first_not_of("+-:0123456789ZzUTCGM"));
  Cursor own(zone);
  time.zone_s = take_zone(own);
  return time.zone_s && cursor.take_word(zone);
}

bool take_letter(char letter, bool digit_follows, Cursor& cursor, Parts& parts) {
  const auto number = [&](int& part, std::size_t digits) {
    if (letter == 'e') cursor.take_blanks();
    part = cursor.take_number(digit_follows ? digits : 1, digits);
    return part >= 0;
  };
  switch (letter) {
    case 'Y':
      return (parts.year = cursor.take_number(4)) >= 0;
    case 'y':
      return (parts.year = cursor.take_number(2)) >= 0 && (parts.year = full_year(parts.year)) > 0;
    case 'm':
      return number(parts.month, 2);
    case 'b':
    case 'B':
      parts.month = month_of(cursor.take_letters());
      cursor.take('.');
      return parts.month > 0;
    case 'd':
    case 'e':
      return number(parts.day, 2);
    case 'H':
      return number(parts.hour, 2) && parts.hour < 25;
    case 'I':
      return number(parts.hour_of_half, 2) && parts.hour_of_half > 0 && parts.hour_of_half < 13;
    case 'M':
      return number(parts.minute, 2) && parts.minute < 60;
    case 'S':
      return number(parts.second, 2) && parts.second < 61 && take_fraction(cursor, parts.time);
    case 'p':
      return take_half(cursor, parts);
    case 'z':
      return take_zone_letters(cursor, parts.time);
    case 'Z':
    case 'a':
    case 'A':
      return !cursor.take_letters().empty();
    case 'j':
      return number(parts.day_of_year, 3) && parts.day_of_year > 0;
    case 's':
      return take_seconds_since_1970(cursor, parts);
    default:
      return cursor.take('%');
  }
}

std::optional<CalendarTime> assembled(Parts parts) {
  CalendarTime time = parts.time;
  if (parts.whole) return time;
  if (parts.hour_of_half > 0)
    parts.hour = parts.hour_of_half % 12 + (parts.afternoon.value_or(false) ? 12 : 0);
  time.second_of_day = 3600 * parts.hour + 60 * parts.minute + parts.second;
  time.year = parts.year;
  time.month = parts.month;
  time.day = parts.day;
  if (parts.day_of_year > 0) {
    const std::chrono::sys_days first = std::chrono::year(parts.year) / 1 / 1;
    set_date(time, first + std::chrono::days(parts.day_of_year - 1));
  }
  return time;
}

}  // namespace

TimeFormat::TimeFormat(const std::string& pattern, const std::string& option) : pattern_(pattern) {
  static constexpr std::array<std::pair<char, std::string_view>, 5> kShort = {
      {{'F', "%Y-%m-%d"}, {'T', "%H:%M:%S"}, {'D', "%m/%d/%y"}, {'R', "%H:%M"}, {'h', "%b"}}};
  const auto refuse = [&](const std::string& message) {
    throw config::InputError(
        {option, 0, 0, config::Severity::kError, "", "'" + pattern + "' " + message});
  };
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    plain_ += pattern[i];
    if (pattern[i] != '%') continue;
    const char letter = ++i < pattern.size() ? pattern[i] : '\0';
    plain_ += letter;
    const auto found = std::find_if(kShort.begin(), kShort.end(),
                                    [letter](const auto& entry) { return entry.first == letter; });
    if (found != kShort.end())
      plain_.replace(plain_.size() - 2, 2, found->second);
    else if (kLetters.find(letter) == std::string_view::npos)
      refuse(std::string("has %") + letter +
             "; known are %Y %y %m %b %B %d %e %H %I %M %S %p %z %Z %a %A %j " + "%s %F %T %D %R");
  }
  const auto has = [this](std::string_view letter) {
    return plain_.find(letter) != std::string::npos;
  };
  const bool year = has("%Y") || has("%y");
  const bool day = has("%j") || ((has("%m") || has("%b") || has("%B")) && (has("%d") || has("%e")));
  if (!has("%s") && !(year && day))
    refuse("does not tell year, month and day; a format is written like '%d.%m.%Y %H:%M:%S'");
}

std::optional<CalendarTime> TimeFormat::parse(std::string_view text) const {
  Cursor cursor(text);
  Parts parts;
  for (std::size_t i = 0; i < plain_.size(); ++i) {
    if (plain_[i] == ' ') {
      cursor.take_blanks();
    } else if (plain_[i] != '%') {
      if (!cursor.take(plain_[i])) return std::nullopt;
    } else {
      const char letter = plain_[++i];
      const bool digit_follows = i + 1 < plain_.size() && plain_[i + 1] == '%';
      if (!take_letter(letter, digit_follows, cursor, parts)) return std::nullopt;
    }
  }
  if (!cursor.done()) return std::nullopt;
  const bool past_midnight =
      parts.hour == 24 && (parts.minute > 0 || parts.second > 0 || parts.time.fraction_ns > 0);
  return past_midnight ? std::nullopt : assembled(parts);
}

}  // namespace mpm::files
