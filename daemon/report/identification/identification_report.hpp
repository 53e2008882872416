#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/report/identification/identification_run.hpp"

namespace mpm::report {

/// p-value of a residual test below which it is said aloud.
inline constexpr double kSuspicious = 0.001;

/// What `mpm identify --json` prints and model.json holds.
[[nodiscard]] nlohmann::ordered_json to_json(const IdentificationRun& run);
/// What it prints otherwise.
[[nodiscard]] std::string to_text(const IdentificationRun& run);

/// Whether any channel was identified.
[[nodiscard]] bool found_any(const IdentificationRun& run);

}  // namespace mpm::report
