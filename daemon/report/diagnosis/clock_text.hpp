#pragma once

#include <string>

/// Moments as people read them.
namespace mpm::report {

/// A moment on the clock of the data: seconds of the run, or, from 1980 on, ISO 8601 in UTC.
[[nodiscard]] std::string clock_text(double seconds);
/// True where clock_text() writes a date.
[[nodiscard]] bool is_date(double seconds);

}  // namespace mpm::report
