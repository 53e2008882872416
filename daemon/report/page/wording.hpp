#pragma once

#include <memory>
#include <string>

#include "daemon/files/times/time_zone.hpp"

/// How the page says numbers, times and odds: defined here once. Where an interval is not known,
/// its ends are NaN.
namespace mpm::report {

/// Digits after the point (negative: before it) with which `value` is said: two digits of its
/// interval's half width, three of its own where there is no interval.
[[nodiscard]] int decimals_of(double value, double low, double high);
/// "1.41", "−0.0026", "3.2·10⁻⁶": so many decimals; "–" where it is not known.
[[nodiscard]] std::string fixed_text(double value, int decimals);
/// A number rounded by its interval, with its unit: "1.402 bar".
[[nodiscard]] std::string rounded(double value, double low, double high,
                                  const std::string& unit = {});
/// Three digits at most: "1.4 bar".
[[nodiscard]] std::string rounded(double value, const std::string& unit = {});
/// The interval itself, in the same digits: "1.381 to 1.424"; empty where there is none.
[[nodiscard]] std::string interval(double value, double low, double high);

/// "14 min" of 840 s, rounded by its interval, whose ends are in s too.
[[nodiscard]] std::string duration(double seconds, double low, double high);
[[nodiscard]] std::string duration(double seconds);
[[nodiscard]] std::string duration_interval(double seconds, double low, double high);

/// A probability in words.
[[nodiscard]] const char* likelihood(double probability);
/// The words and what they stand for, for a footnote.
[[nodiscard]] std::string likelihood_legend();

/// Moments on the clock of the data: dates in a zone, or, where the data have none, time since the
/// beginning of the data's own clock.
class Clock {
 public:
  /// `start_s`: of the data; from 1980 on its clock tells dates. `zone`: null = UTC.
  Clock(double start_s, double sample_time_s, std::shared_ptr<const files::TimeZone> zone);

  [[nodiscard]] bool dated() const { return dated_; }
  /// "UTC", "Europe/Berlin"; empty where there are no dates.
  [[nodiscard]] std::string zone() const;
  /// "3 May 2024 14:20", "4.2 h"
  [[nodiscard]] std::string at(double seconds) const;
  /// "3 May 2024 14:20 to 5 May 2024 03:10 (UTC)"
  [[nodiscard]] std::string between(double from_s, double until_s) const;

 private:
  bool dated_;
  bool seconds_;
  std::shared_ptr<const files::TimeZone> zone_;
};

}  // namespace mpm::report
