#pragma once

#include <nlohmann/json.hpp>

#include "daemon/report/identification/identification_run.hpp"

namespace mpm::report {

/// The same page of an identification: keys as of a diagnosis, those that it has.
[[nodiscard]] nlohmann::ordered_json page_data(const IdentificationRun& run);

}  // namespace mpm::report
