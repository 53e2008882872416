#pragma once

#include <string>

#include "config/unit_config.hpp"
#include "daemon/files/times/time_zone.hpp"
#include "daemon/report/detect_report.hpp"
#include "daemon/report/terminal/terminal_text.hpp"

namespace mpm::report {

/// A report for a person: what was read, the matrix of verdicts, a line per mismatch, one per
/// channel that is undetermined, and the alarms that are over. Times are in `zone`, null = UTC.
[[nodiscard]] std::string to_text(const DetectReport& report, const config::UnitConfig& unit,
                                  const Layout& layout = {}, const files::TimeZone* zone = nullptr);

}  // namespace mpm::report
