#pragma once

#include "daemon/http/board.hpp"
#include "daemon/http/unit_json.hpp"

namespace mpm::http {

/// How the monitor itself fares: health of each unit in the words of NE 107 with its troubles,
/// counters and rates, and the process. `started_ns`: since 1970.
[[nodiscard]] Json system_json(const Board& board, const std::string& version,
                               std::int64_t started_ns);

}  // namespace mpm::http
