#include "config/time_text.hpp"

#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>

namespace mpm::config {
namespace {

constexpr std::int64_t kLatestSeconds = 9'000'000'000;  // in ns it still fits

/// Takes `digits` digits off the front of `text`.
std::optional<int> take_number(std::string_view& text, std::size_t digits) {
  if (text.size() < digits) return std::nullopt;
  int value = 0;
  for (const char digit : text.substr(0, digits)) {
    if (digit < '0' || digit > '9') return std::nullopt;
    value = 10 * value + (digit - '0');
  }
  text.remove_prefix(digits);
  return value;
}

bool take(std::string_view& text, char letter) {
  if (text.empty() || text.front() != letter) return false;
  text.remove_prefix(1);
  return true;
}

/// `.5` and the like, to nanoseconds; what is finer is cut off.
std::int64_t take_fraction(std::string_view& text) {
  std::int64_t result = 0;
  std::int64_t unit = 1000000000;
  while (!text.empty() && text.front() >= '0' && text.front() <= '9') {
    unit /= 10;
    result += unit * (text.front() - '0');
    text.remove_prefix(1);
  }
  return result;
}

std::optional<std::int64_t> parse_iso(std::string_view text) {
  const auto year = take_number(text, 4);
  if (!year || !take(text, '-')) return std::nullopt;
  const auto month = take_number(text, 2);
  if (!month || !take(text, '-')) return std::nullopt;
  const auto day = take_number(text, 2);
  if (!day || !(take(text, 'T') || take(text, ' '))) return std::nullopt;
  const auto hour = take_number(text, 2);
  if (!hour || !take(text, ':')) return std::nullopt;
  const auto minute = take_number(text, 2);
  if (!minute) return std::nullopt;
  int second = 0;
  std::int64_t fraction_ns = 0;
  if (take(text, ':')) {
    const auto given = take_number(text, 2);
    if (!given) return std::nullopt;
    second = *given;
    if (take(text, '.')) fraction_ns = take_fraction(text);
  }
  int zone_minutes = 0;
  if (!take(text, 'Z')) {
    const int sign = take(text, '+') ? 1 : take(text, '-') ? -1 : 0;
    const auto zone_hour = take_number(text, 2);
    take(text, ':');
    const auto zone_minute = take_number(text, 2);
    if (sign == 0 || !zone_hour || !zone_minute) return std::nullopt;
    zone_minutes = sign * (60 * *zone_hour + *zone_minute);
  }
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!text.empty() || !date.ok() || *hour > 23 || *minute > 59 || second > 59) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  const std::int64_t seconds = ((days * 24 + *hour) * 60 + *minute - zone_minutes) * 60 + second;
  if (std::abs(seconds) >= kLatestSeconds) return std::nullopt;
  return seconds * 1000000000 + fraction_ns;
}

}  // namespace

std::optional<std::int64_t> parse_time(std::string_view text) {
  double seconds = 0.0;
  const char* end = text.data() + text.size();
  const std::from_chars_result number = std::from_chars(text.data(), end, seconds);
  if (number.ec == std::errc() && number.ptr == end) {
    if (!(std::abs(seconds) < kLatestSeconds)) return std::nullopt;
    return std::llround(seconds * 1e9);
  }
  return parse_iso(text);
}

}  // namespace mpm::config
