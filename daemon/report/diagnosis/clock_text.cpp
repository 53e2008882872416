#include "daemon/report/diagnosis/clock_text.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>

#include "core/text/number_text.hpp"

namespace mpm::report {

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
