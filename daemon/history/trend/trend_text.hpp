#pragma once

#include <string>

#include "daemon/history/trend/changes.hpp"
#include "daemon/report/terminal/terminal_text.hpp"

namespace mpm::history {

/// Tables of prediction errors and gains by period, and what changed, in words. `zone`: in which
/// times are told; null = UTC.
[[nodiscard]] std::string to_text(const Trend& trend, const Findings& findings,
                                  const report::Layout& layout, const files::TimeZone* zone);

}  // namespace mpm::history
