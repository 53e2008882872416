#include "daemon/io/time_text.hpp"

#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <limits>

namespace mpm::io {
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

std::optional<std::int64_t> parse_iso(std::string_view text, std::string& problem) {
  Cursor cursor(text);
  problem = "is no time: give seconds or ISO 8601 such as 2024-05-01T12:00:00Z";
  const int year = cursor.take_number(4);
  if (!cursor.take('-')) return std::nullopt;
  const int month = cursor.take_number(2);
  if (!cursor.take('-')) return std::nullopt;
  const int day = cursor.take_number(2);
  if (!cursor.take('T') && !cursor.take(' ') && !cursor.take('t')) return std::nullopt;
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
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (year < 0 || month < 0 || day < 0 || !date.ok() || hour < 0 || hour > 23 || minute < 0 ||
      minute > 59 || second < 0 || second > 60)  // 60 = leap second
    return std::nullopt;
  if (cursor.done()) {
    problem = "is a local time: add its zone, Z or +hh:mm";
    return std::nullopt;
  }
  const std::optional<int> zone_s = parse_zone(cursor);
  if (!zone_s) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  const std::int64_t seconds = 86400 * days + 3600 * hour + 60 * minute + second - *zone_s;
  if (std::abs(seconds) >= kLatestNs / kNsPerSecond) {
    problem = "is out of range";
    return std::nullopt;
  }
  problem.clear();
  return seconds * kNsPerSecond + fraction_ns;
}

}  // namespace

std::optional<std::int64_t> parse_time(std::string_view text, std::string& problem) {
  const bool iso = text.size() > 5 && text[4] == '-' && is_digit(text[0]);
  return iso ? parse_iso(text, problem) : parse_seconds(text, problem);
}

}  // namespace mpm::io
