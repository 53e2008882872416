#include "daemon/files/times/time_text.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>

#include "core/signal/nanoseconds.hpp"
#include "daemon/files/times/calendar_time.hpp"
#include "daemon/files/times/cursor.hpp"

namespace mpm::files {
namespace {

constexpr std::int64_t kLatestNs = std::numeric_limits<std::int64_t>::max() / 2;
constexpr std::uint64_t kEarliestEpochS = 900'000'000;  // 1998
constexpr int kMostDigits = 18;                         // always fits an int64

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

/// Three, six or nine digits with their point; empty for none.
std::string fraction_text(std::int64_t fraction_ns) {
  if (fraction_ns == 0) return {};
  std::string digits = std::to_string(kSecondNs + fraction_ns);
  digits[0] = '.';
  while (digits.size() > 4 && digits.ends_with("000")) digits.resize(digits.size() - 3);
  return digits;
}

}  // namespace

const char* const kNoTime = "is no time: give seconds or ISO 8601 such as 2024-05-01T12:00:00Z";

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
    problem = kNoTime;
    return std::nullopt;
  }
  const std::optional<std::int64_t> value = scaled(digits, exponent);
  if (!value) {
    problem = "is out of range";
    return std::nullopt;
  }
  return negative ? -*value : *value;
}

std::optional<EpochTime> parse_epoch(std::string_view text) {
  struct Unit {
    const char* name;
    std::uint64_t per_second;
  };
  static constexpr std::array<Unit, 3> kUnits = {
      {{"milliseconds", 1'000}, {"microseconds", 1'000'000}, {"nanoseconds", 1'000'000'000}}};
  Cursor cursor(text);
  const std::string_view digits = cursor.take_digits(19);
  const std::string_view fraction = cursor.take('.') ? cursor.take_digits() : std::string_view();
  if (!cursor.done()) return std::nullopt;
  std::uint64_t number = 0;
  for (const char c : digits) number = 10 * number + static_cast<std::uint64_t>(c - '0');
  for (const Unit& unit : kUnits) {
    if (number / unit.per_second < kEarliestEpochS ||
        number / unit.per_second >= static_cast<std::uint64_t>(kLatestNs / kSecondNs))
      continue;
    const std::int64_t unit_ns = kSecondNs / static_cast<std::int64_t>(unit.per_second);
    return EpochTime{static_cast<std::int64_t>(number) * unit_ns +
                         fraction_ns_of(fraction) * unit_ns / kSecondNs,
                     unit.name};
  }
  return std::nullopt;
}

std::optional<std::int64_t> moment_ns(std::int64_t utc_s, std::int64_t fraction_ns) {
  if (std::abs(utc_s) >= kLatestNs / kSecondNs) return std::nullopt;
  return utc_s * kSecondNs + fraction_ns;
}

std::optional<std::int64_t> parse_time(std::string_view text, std::string& problem) {
  const std::optional<CalendarTime> written = parse_calendar(text);
  if (!written) return parse_seconds(text, problem);
  const std::optional<LocalTime> local = written->local(DateOrder::kUnknown);
  problem = kNoTime;
  if (!local) return std::nullopt;
  problem = "is a local time: add its zone, Z or +hh:mm";
  if (!written->zone_s) return std::nullopt;
  problem.clear();
  const auto time_ns = moment_ns(local->seconds - *written->zone_s, local->fraction_ns);
  if (!time_ns) problem = "is out of range";
  return time_ns;
}

std::string utc_text(std::int64_t time_ns, int offset_s) {
  const std::int64_t second = floor_division(time_ns, kSecondNs);
  const std::int64_t fraction_ns = (time_ns % kSecondNs + kSecondNs) % kSecondNs;
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
  const std::int64_t whole = time_ns / kSecondNs;
  const std::int64_t fraction = std::abs(time_ns % kSecondNs);
  const char* sign = time_ns < 0 && whole == 0 ? "-" : "";
  return sign + std::to_string(whole) + fraction_text(fraction);
}

}  // namespace mpm::files
