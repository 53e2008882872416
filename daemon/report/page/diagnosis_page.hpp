#pragma once

#include <nlohmann/json.hpp>

#include "daemon/report/diagnosis/diagnosis_run.hpp"

namespace mpm::report {

/// Everything that a diagnosis's report.html shows, said and computed: its script only draws. The
/// parts stand in the order of the page; page.js lists them.
[[nodiscard]] nlohmann::ordered_json page_data(const DiagnosisRun& run);

}  // namespace mpm::report
