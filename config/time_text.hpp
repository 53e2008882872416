#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace mpm::config {

/// Seconds since 1970 as a number, or ISO 8601 with a zone (2024-03-01T12:00:00.5+01:00, or Z), to
/// nanoseconds since 1970. Nothing if `text` is neither.
[[nodiscard]] std::optional<std::int64_t> parse_time(std::string_view text);

}  // namespace mpm::config
