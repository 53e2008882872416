#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mpm::files {

/// Why numbers in a time column are the days of a spreadsheet (since 1900, the time of day as a
/// fraction) rather than seconds, one line for a person; empty where they may be seconds.
/// `days`: the first times of the file; `sample_time_s` between its rows, 0 = not known.
[[nodiscard]] std::string serial_date_problem(const std::vector<double>& days,
                                              double sample_time_s);
/// The same of one number that stands where a date is, beside a column for the time of day.
[[nodiscard]] std::string serial_day_problem(double day);

/// The same of a count of 100 ns since 1601 (FILETIME) or since the year 1 (.NET ticks).
[[nodiscard]] std::string tick_problem(std::string_view text);

}  // namespace mpm::files
