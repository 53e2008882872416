#include "daemon/files/times/time_text.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>

namespace mpm::files {
namespace {

constexpr std::int64_t kLatestNs = std::numeric_limits<std::int64_t>::max() / 2;
constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr int kMostDigits = 18;  // always fits an int64

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Takes leading pieces off a text.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : rest_(text) {}

  [[nodiscard]] bool done() const { return rest_.empty(); }
  [[nodiscard]] char peek() const { return rest_.empty() ? '\0' : rest_.front(); }
  bool take(char c) {
    if (peek() != c || rest_.empty()) return false;
    rest_.remove_prefix(1);
    return true;
  }
  bool take_word(std::string_view word) {
    if (rest_.substr(0, word.size()) != word) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  std::string_view take_digits() {
    std::size_t count = 0;
    while (count < rest_.size() && is_digit(rest_[count])) ++count;
    const std::string_view digits = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return digits;
  }
  /// A number of exactly `count` digits, or -1.
  int take_number(std::size_t count) {
    int value = 0;
    if (rest_.size() < count) return -1;
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_digit(rest_[i])) return -1;
      value = 10 * value + (rest_[i] - '0');
    }
    rest_.remove_prefix(count);
    return value;
  }

 private:
  std::string_view rest_;
};

/// digits * 10^exponent, rounded half up; nothing beyond 18 digits.
std::optional<std::int64_t> scaled(std::string_view digits, int exponent) {
  while (!digits.empty() && digits.front() == '0') digits.remove_prefix(1);
  if (digits.empty()) return 0;
  const int length = static_cast<int>(digits.size()) + exponent;  // digits before the point
  if (length > kMostDigits + 1) return std::nullopt;
  if (length < 0) return 0;
  std::uint64_t value = 0;
  for (int i = 0; i < length; ++i) {
    const auto at = static_cast<std::size_t>(i);
    value = 10 * value + (at < digits.size() ? static_cast<std::uint64_t>(digits[at] - '0') : 0U);
  }
  const auto next = static_cast<std::size_t>(length);
  if (next < digits.size() && digits[next] >= '5') ++value;
  if (value > static_cast<std::uint64_t>(kLatestNs)) return std::nullopt;
  return static_cast<std::int64_t>(value);
}

std::optional<std::int64_t> parse_seconds(std::string_view text, std::string& problem) {
  Cursor cursor(text);
  const bool negative = cursor.take('-');
  if (!negative) cursor.take('+');
  std::string digits(cursor.take_digits());
  int exponent = 9;  // s to ns
  if (cursor.take('.') || cursor.take(',')) {
    const std::string_view fraction = cursor.take_digits();
    digits += fraction;
    exponent -= static_cast<int>(fraction.size());
  }
  bool well_formed = !digits.empty();
  if (cursor.take('e') || cursor.take('E')) {
    const bool down = cursor.take('-');
    if (!down) cursor.take('+');
    const std::string_view power = cursor.take_digits();
    well_formed = well_formed && !power.empty() && power.size() <= 3;
    int value = 0;
    for (const char c : power.substr(0, 3)) value = 10 * value + (c - '0');
    exponent += down ? -value : value;
  }
  if (!well_formed || !cursor.done()) {
    problem = "is no time: give seconds or ISO 8601 such as 2024-05-01T12:00:00Z";
    return std::nullopt;
  }
  const std::optional<std::int64_t> value = scaled(digits, exponent);
  if (!value) {
    problem = "is out of range";
    return std::nullopt;
  }
  return negative ? -*value : *value;
}

/// Seconds east of UTC, or nothing where there is no zone.
std::optional<int> parse_zone(Cursor& cursor) {
  cursor.take(' ');
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

/// hh:mm[:ss[.fraction]] of a day.
std::optional<LocalTime> parse_clock(Cursor& cursor, const std::chrono::year_month_day& date) {
  const int hour = cursor.take_number(2);
  if (!cursor.take(':')) return std::nullopt;
  const int minute = cursor.take_number(2);
  int second = 0;
  std::int64_t fraction_ns = 0;
  if (cursor.take(':')) {
    second = cursor.take_number(2);
    if (cursor.take('.') || cursor.take(',')) {
      const std::string_view digits = cursor.take_digits();
      if (digits.empty()) return std::nullopt;
      fraction_ns = scaled(digits, 9 - static_cast<int>(digits.size())).value_or(0);
    }
  }
  if (!date.ok() || hour < 0 || hour > 23 || minute < 0 || minute > 59 || second < 0 ||
      second > 60)  // 60 = leap second
    return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return LocalTime{86400 * days + 3600 * hour + 60 * minute + second, fraction_ns};
}

std::optional<std::chrono::year_month_day> make_date(int year, int month, int day) {
  if (year < 0 || month < 0 || day < 0) return std::nullopt;
  return std::chrono::year_month_day{std::chrono::year(year),
                                     std::chrono::month(static_cast<unsigned>(month)),
                                     std::chrono::day(static_cast<unsigned>(day))};
}

/// 2024-05-01T12:00:00, without a zone.
std::optional<LocalTime> parse_iso_clock(Cursor& cursor) {
  const int year = cursor.take_number(4);
  if (!cursor.take('-')) return std::nullopt;
  const int month = cursor.take_number(2);
  if (!cursor.take('-')) return std::nullopt;
  const int day = cursor.take_number(2);
  if (!cursor.take('T') && !cursor.take(' ') && !cursor.take('t')) return std::nullopt;
  const auto date = make_date(year, month, day);
  return date ? parse_clock(cursor, *date) : std::nullopt;
}

/// 01.05.2024 12:00:00
std::optional<LocalTime> parse_dotted_clock(Cursor& cursor) {
  const int day = cursor.take_number(2);
  if (!cursor.take('.')) return std::nullopt;
  const int month = cursor.take_number(2);
  if (!cursor.take('.')) return std::nullopt;
  const int year = cursor.take_number(4);
  if (!cursor.take(' ')) return std::nullopt;
  const auto date = make_date(year, month, day);
  return date ? parse_clock(cursor, *date) : std::nullopt;
}

std::optional<std::int64_t> parse_iso(std::string_view text, std::string& problem) {
  Cursor cursor(text);
  problem = "is no time: give seconds or ISO 8601 such as 2024-05-01T12:00:00Z";
  const std::optional<LocalTime> local = parse_iso_clock(cursor);
  if (!local) return std::nullopt;
  if (cursor.done()) {
    problem = "is a local time: add its zone, Z or +hh:mm";
    return std::nullopt;
  }
  const std::optional<int> zone_s = parse_zone(cursor);
  if (!zone_s) return std::nullopt;
  const std::int64_t seconds = local->seconds - *zone_s;
  if (std::abs(seconds) >= kLatestNs / kNsPerSecond) {
    problem = "is out of range";
    return std::nullopt;
  }
  problem.clear();
  return seconds * kNsPerSecond + local->fraction_ns;
}

/// Three, six or nine digits with their point; empty for none.
std::string fraction_text(std::int64_t fraction_ns) {
  if (fraction_ns == 0) return {};
  std::string digits = std::to_string(kNsPerSecond + fraction_ns);
  digits[0] = '.';
  while (digits.size() > 4 && digits.ends_with("000")) digits.resize(digits.size() - 3);
  return digits;
}

}  // namespace

std::optional<std::int64_t> parse_time(std::string_view text, std::string& problem) {
  const bool iso = text.size() > 5 && text[4] == '-' && is_digit(text[0]);
  return iso ? parse_iso(text, problem) : parse_seconds(text, problem);
}

std::optional<LocalTime> parse_local_time(std::string_view text) {
  const bool dotted = text.size() > 2 && text[2] == '.';
  Cursor cursor(text);
  const std::optional<LocalTime> local =
      dotted ? parse_dotted_clock(cursor) : parse_iso_clock(cursor);
  if (!local || !cursor.done()) return std::nullopt;
  if (std::abs(local->seconds) >= kLatestNs / kNsPerSecond - 2 * 86400) return std::nullopt;
  return local;
}

std::string utc_text(std::int64_t time_ns, int offset_s) {
  const std::int64_t second = time_ns / kNsPerSecond - (time_ns % kNsPerSecond < 0 ? 1 : 0);
  const std::int64_t fraction_ns = (time_ns % kNsPerSecond + kNsPerSecond) % kNsPerSecond;
  const std::chrono::sys_seconds local{std::chrono::seconds(second + offset_s)};
  const auto day = std::chrono::floor<std::chrono::days>(local);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss clock(local - day);
  std::array<char, 80> text{};
  int size = std::snprintf(
      text.data(), text.size(), "%04d-%02u-%02uT%02d:%02d:%02d", static_cast<int>(date.year()),
      static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
      static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
      static_cast<int>(clock.seconds().count()));
  std::string result(text.data(), static_cast<std::size_t>(size));
  result += fraction_text(fraction_ns);
  if (offset_s == 0) return result + 'Z';
  const int minutes = std::abs(offset_s) / 60;
  size = std::snprintf(text.data(), text.size(), "%c%02d:%02d", offset_s < 0 ? '-' : '+',
                       minutes / 60, minutes % 60);
  return result.append(text.data(), static_cast<std::size_t>(size));
}

std::string formatted_utc(std::int64_t utc_s, const char* format) {
  const std::time_t time = utc_s;
  std::tm parts{};
  gmtime_r(&time, &parts);
  std::array<char, 64> text{};
  return {text.data(), std::strftime(text.data(), text.size(), format, &parts)};
}

std::string seconds_text(std::int64_t time_ns) {
  const std::int64_t whole = time_ns / kNsPerSecond;
  const std::int64_t fraction = std::abs(time_ns % kNsPerSecond);
  const char* sign = time_ns < 0 && whole == 0 ? "-" : "";
  return sign + std::to_string(whole) + fraction_text(fraction);
}

}  // namespace mpm::files
