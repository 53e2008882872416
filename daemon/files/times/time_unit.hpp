#pragma once

namespace mpm::files {

/// A unit of time, as it is written behind a number.
struct TimeUnit {
  const char* name;
  double seconds;
};
/// The unit in which a duration is read best: the largest of s, min, h and days of which it has
/// two.
[[nodiscard]] TimeUnit time_unit_of(double seconds);

}  // namespace mpm::files
