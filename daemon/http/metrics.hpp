#pragma once

#include <cstdint>
#include <string>

#include "daemon/http/board.hpp"

namespace mpm::http {

inline constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";

/// All units and the process for Prometheus, in its text format 0.0.4: base units, counters that
/// end in _total, one series per channel and verdict. `started_ns`: UTC since 1970.
[[nodiscard]] std::string metrics_text(const Board& board, const std::string& version,
                                       std::int64_t started_ns);

}  // namespace mpm::http
