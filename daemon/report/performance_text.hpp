#pragma once

#include <string>

#include "core/record/performance_record.hpp"
#include "daemon/report/terminal/terminal_text.hpp"

namespace mpm::report {

/// The indices of control performance as three tables, of CVs, their predictions
/// and MVs; `--` where something cannot
/// be told.
[[nodiscard]] std::string performance_text(const PerformanceRecord& record, const Layout& layout);

}  // namespace mpm::report
