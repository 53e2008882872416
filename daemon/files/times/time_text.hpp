#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mpm::files {

/// A time cell: decimal seconds (point or comma, exact to the nanosecond) or ISO 8601 with a zone
/// (`Z`, `+hh:mm`, `UTC`). In ns, the latter since 1970. Where it is none, `problem` says why.
/// Times lie between 1825 and 2115, so that their differences fit.
[[nodiscard]] std::optional<std::int64_t> parse_time(std::string_view text, std::string& problem);

/// What a clock showed, of which only its zone tells the moment.
struct LocalTime {
  std::int64_t seconds = 0;  ///< since 1970, counted as if it were UTC
  std::int64_t fraction_ns = 0;
};

/// `2024-05-01T12:00:00` or `01.05.2024 12:00:00`, with fractions or without seconds. Nothing for
/// any other text, nor where a zone follows.
[[nodiscard]] std::optional<LocalTime> parse_local_time(std::string_view text);

/// ISO 8601 with `Z`, or with the zone's offset from UTC in s. Fractions as needed, exact.
[[nodiscard]] std::string utc_text(std::int64_t time_ns, int offset_s = 0);
/// Decimal seconds, exact.
[[nodiscard]] std::string seconds_text(std::int64_t time_ns);

}  // namespace mpm::files
