#pragma once

#include <nlohmann/json.hpp>

#include "daemon/report/diagnosis/diagnosis_run.hpp"

namespace mpm::report {

/// Everything that report.html shows, computed: its script only draws. Keys are listed at the head
/// of page/page.js. Long series are thinned so that the page stays below 5 MB.
[[nodiscard]] nlohmann::ordered_json page_data(const DiagnosisRun& run);

}  // namespace mpm::report
