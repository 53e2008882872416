#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/report/identification/identification_run.hpp"

namespace mpm::report {

/// The test plan of a run that has one.
[[nodiscard]] nlohmann::ordered_json plan_json(const IdentificationRun& run);
[[nodiscard]] std::string plan_text(const IdentificationRun& run);

/// The limits that count of each signal, as the unit file says them.
[[nodiscard]] TestLimits test_limits(const config::UnitConfig& unit);

}  // namespace mpm::report
