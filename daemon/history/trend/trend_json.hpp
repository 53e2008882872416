#pragma once

#include <nlohmann/json.hpp>

#include "daemon/history/trend/changes.hpp"

namespace mpm::history {

/// The object of docs/trend.md. What is not known is null.
[[nodiscard]] nlohmann::ordered_json to_json(const Trend& trend, const Findings& findings,
                                             const files::TimeZone* zone);

}  // namespace mpm::history
