#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mpm::files {

/// Decimal seconds (point or comma, exact to the nanosecond), or a date and time of day with a zone
/// (`Z`, `+hh:mm`, `UTC`), such as ISO 8601. In ns, the latter since 1970. Where it is none,
/// `problem` says why. Times lie between 1825 and 2115, so that their differences fit.
[[nodiscard]] std::optional<std::int64_t> parse_time(std::string_view text, std::string& problem);

/// Decimal seconds alone.
[[nodiscard]] std::optional<std::int64_t> parse_seconds(std::string_view text,
                                                        std::string& problem);

/// Milli-, micro- or nanoseconds since 1970, told by how large the number is: one that lies between
/// 1998 and 2115 in one of them and in no other. Nothing for any other text.
struct EpochTime {
  std::int64_t time_ns = 0;
  const char* unit = "";
};
[[nodiscard]] std::optional<EpochTime> parse_epoch(std::string_view text);

/// In ns since 1970; nothing where it is out of range.
[[nodiscard]] std::optional<std::int64_t> moment_ns(std::int64_t utc_s, std::int64_t fraction_ns);

/// `is no time: ...` with what a time looks like.
extern const char* const kNoTime;

/// ISO 8601 with `Z`, or with the zone's offset from UTC in s. Fractions as needed, exact.
[[nodiscard]] std::string utc_text(std::int64_t time_ns, int offset_s = 0);
/// A whole second of UTC since 1970, as strftime's `format` says; at most 63 letters.
[[nodiscard]] std::string formatted_utc(std::int64_t utc_s, const char* format);
/// Decimal seconds, exact.
[[nodiscard]] std::string seconds_text(std::int64_t time_ns);

}  // namespace mpm::files
