#include "daemon/files/times/serial_dates.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "daemon/files/times/cursor.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::files {
namespace {

constexpr double kSecondsPerDay = 86400.0;
constexpr double kDaysTo1970 = 25569.0;                    // from the first day of a spreadsheet
constexpr double kFirstDay = 29221.0, kLastDay = 73051.0;  // 1980 to 2100
constexpr double kTolerance = 0.1;                         // as between rows and sample time

constexpr std::int64_t kTicksPerSecond = 10'000'000;
constexpr std::int64_t kEarliest = 315'532'800, kLatest = 4'102'444'800;  // the same years, s

// Rows an hour apart at most are days with a fraction; no process is sampled in such seconds.
constexpr double kLongestStep = 0.05;

/// Between times that differ; 0 if none do.
double median_step(const std::vector<double>& times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i)
    if (times[i] > times[i - 1]) steps.push_back(times[i] - times[i - 1]);
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

bool is_day(double number) { return number >= kFirstDay && number < kLastDay; }

std::string as_date(double day, const char* format) {
  const auto second = static_cast<std::int64_t>(std::llround((day - kDaysTo1970) * kSecondsPerDay));
  return formatted_utc(second, format);
}

bool is_about(double value, double wanted) {
  return std::abs(value - wanted) <= kTolerance * wanted;
}

}  // namespace

std::string serial_date_problem(const std::vector<double>& days, double sample_time_s) {
  if (days.empty() || !std::all_of(days.begin(), days.end(), is_day)) return {};
  const double step = median_step(days);
  const bool fractions =
      std::any_of(days.begin(), days.end(), [](double day) { return day != std::floor(day); });
  const bool by_unit = sample_time_s > 0.0 && !is_about(step, sample_time_s);
  const bool rows_fit = by_unit && is_about(step * kSecondsPerDay, sample_time_s);
  const bool rows_tell = fractions && step < kLongestStep && (by_unit || sample_time_s <= 0.0);
  if (!rows_fit && !rows_tell) return {};
  return "is a day number of a spreadsheet (" + as_date(days.front(), "%Y-%m-%d %H:%M:%S") +
         "), not a time: give the column a date format there, such as yyyy-mm-dd hh:mm:ss, and "
         "export it again; if it is seconds, say so with --time-format %s";
}

std::string serial_day_problem(double day) {
  if (!is_day(day)) return {};
  return "is a day number of a spreadsheet (" + as_date(day, "%Y-%m-%d") +
         "), not a date: give its column a date format there, such as yyyy-mm-dd, that of the time "
         "of day hh:mm:ss, and export them again";
}

std::string tick_problem(std::string_view text) {
  struct Epoch {
    const char* name;
    std::int64_t to_1970_s;
  };
  static constexpr Epoch kEpochs[] = {{"a Windows FILETIME", 11'644'473'600},
                                      {".NET ticks", 62'135'596'800}};
  Cursor cursor(text);
  std::int64_t ticks = 0;
  for (const char c : cursor.take_digits(18)) ticks = 10 * ticks + (c - '0');
  if (text.size() != 18 || !cursor.done()) return {};
  for (const Epoch& epoch : kEpochs) {
    const std::int64_t second = ticks / kTicksPerSecond - epoch.to_1970_s;
    if (second < kEarliest || second >= kLatest) continue;
    return std::string("is ") + epoch.name + " (" + formatted_utc(second, "%Y-%m-%dT%H:%M:%SZ") +
           "), which is not read: export the times as dates, or as milliseconds since 1970";
  }
  return {};
}

}  // namespace mpm::files
