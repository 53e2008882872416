#pragma once

#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "daemon/files/times/time_choice.hpp"
#include "daemon/files/times/time_style.hpp"
#include "daemon/report/diagnosis/other_row.hpp"

namespace mpm::app {

/// Whether the monitor finds no channel a mismatch in the rows of these files with the CVs a row
/// earlier, or later. Asked where channels of several CVs look wrong, for nothing that happens to
/// one channel looks so. Reads the files twice at most.
[[nodiscard]] report::OtherRow find_other_row(const config::UnitConfig& unit,
                                              const std::vector<std::string>& files,
                                              const files::TimeStyle& times,
                                              const files::TimeChoice& choice);

/// The same where nobody has looked yet whether channels of several CVs look wrong; reads them once
/// more.
[[nodiscard]] report::OtherRow find_other_row_if_wrong(const config::UnitConfig& unit,
                                                       const std::vector<std::string>& files,
                                                       const files::TimeStyle& times,
                                                       const files::TimeChoice& choice);

}  // namespace mpm::app
