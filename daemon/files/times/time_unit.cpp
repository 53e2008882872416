#include "daemon/files/times/time_unit.hpp"

#include <cmath>

namespace mpm::files {
namespace {

constexpr double kMinute = 60.0, kHour = 3600.0, kDayS = 86400.0;
constexpr double kOfTheNext = 2.0;  ///< so much of a unit of time is read in it

}  // namespace

TimeUnit time_unit_of(double seconds) {
  const double size = std::abs(seconds);
  if (size >= kOfTheNext * kDayS) return {"days", kDayS};
  if (size >= kOfTheNext * kHour) return {"h", kHour};
  if (size >= kOfTheNext * kMinute) return {"min", kMinute};
  return {"s", 1.0};
}

}  // namespace mpm::files
