#include "daemon/report/diagnosis/number_text.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace mpm::report {

std::string number_text(double value, int digits) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0.0 ? "infinity" : "-infinity";
  if (value == 0.0) return "0";
  char text[48];
  const double size = std::abs(value);
  if (size < 1e-4 || size >= 1e7) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
  }
  const int decimals = std::max(0, digits - 1 - static_cast<int>(std::floor(std::log10(size))));
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  std::string result = text;
  if (decimals > 0) {
    result.erase(result.find_last_not_of('0') + 1);
    if (result.back() == '.') result.pop_back();
  }
  return result == "-0" ? "0" : result;
}

std::string interval_text(double low, double high, int digits) {
  return number_text(low, digits) + " to " + number_text(high, digits);
}

bool is_date(double seconds) { return std::abs(seconds) > 315532800.0; }  // 1980

std::string clock_text(double seconds) {
  if (!is_date(seconds)) return number_text(seconds, 6) + " s";
  const auto whole = static_cast<std::int64_t>(std::floor(seconds));
  const std::chrono::sys_seconds time{std::chrono::seconds(whole)};
  const auto day = std::chrono::floor<std::chrono::days>(time);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss clock{time - day};
  char text[64];
  std::snprintf(text, sizeof text, "%04d-%02u-%02u %02d:%02d:%02d UTC",
                static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                static_cast<unsigned>(date.day()), static_cast<int>(clock.hours().count()),
                static_cast<int>(clock.minutes().count()),
                static_cast<int>(clock.seconds().count()));
  return text;
}

}  // namespace mpm::report
