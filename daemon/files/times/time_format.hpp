#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "daemon/files/times/calendar_time.hpp"

namespace mpm::files {

/// How times are written, in letters of strftime, for what `parse_calendar` does not know:
/// %Y %y %m %b %B %d %e %H %I %M %S (with a fraction, if there is one) %p %z %j %s %F %T %D %R %%;
/// %b and %B in any language that parse_calendar knows, %s = seconds since 1970; %a %A %Z are words
/// that tell nothing. Other letters stand for themselves, a blank for any number of them. Numbers
/// may lack leading zeros where no digit follows.
class TimeFormat {
 public:
  /// Throws config::InputError, naming `option`, for letters that are not known, and where the
  /// format does not tell the day and the year.
  explicit TimeFormat(const std::string& pattern, const std::string& option = "--time-format");

  /// Nothing where the text is written in another way.
  [[nodiscard]] std::optional<CalendarTime> parse(std::string_view text) const;
  [[nodiscard]] const std::string& pattern() const { return pattern_; }

 private:
  std::string pattern_;
  std::string plain_;  ///< without the letters that stand for several
};

}  // namespace mpm::files
