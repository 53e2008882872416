#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mpm::io {

/// A time cell: decimal seconds (point or comma, exact to the nanosecond) or ISO 8601 with a zone
/// (`Z`, `+hh:mm`, `UTC`). In ns, the latter since 1970. Where it is none, `problem` says why.
/// Times lie between 1825 and 2115, so that their differences fit.
[[nodiscard]] std::optional<std::int64_t> parse_time(std::string_view text, std::string& problem);

}  // namespace mpm::io
