#pragma once

#include <string>

/// Numbers as people read them.
namespace mpm::report {

/// `digits` significant ones, no exponent between 1e-4 and 1e7, no trailing zeros; "-" for NaN.
[[nodiscard]] std::string number_text(double value, int digits = 3);
/// "0.72 to 0.78"
[[nodiscard]] std::string interval_text(double low, double high, int digits = 3);
/// A moment on the clock of the data: seconds of the run, or, from 1980 on, ISO 8601 in UTC.
[[nodiscard]] std::string clock_text(double seconds);
/// True where clock_text() writes a date.
[[nodiscard]] bool is_date(double seconds);

}  // namespace mpm::report
