#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/report/diagnosis/diagnosis_run.hpp"

namespace mpm::report {

/// report.json: the object of interfaces, "mpm diagnose", and more keys.
[[nodiscard]] nlohmann::ordered_json to_json(const DiagnosisRun& run);
/// The same, in short, for a terminal.
[[nodiscard]] std::string to_text(const DiagnosisRun& run);

}  // namespace mpm::report
