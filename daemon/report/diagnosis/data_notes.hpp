#pragma once

#include <nlohmann/json.hpp>

#include "daemon/report/diagnosis/diagnosis_run.hpp"

namespace mpm::report {

/// What a historian or a converter has done to the signals that were fitted, one entry for each
/// that it shows in: tag, compressed, interpolated, deadband, quantum, held_share, read_every (of
/// CVs), beyond_use and advice.
[[nodiscard]] nlohmann::ordered_json data_notes(const DiagnosisRun& run);

}  // namespace mpm::report
