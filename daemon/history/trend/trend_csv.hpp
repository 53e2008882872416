#pragma once

#include <string>

#include "daemon/history/trend/trend.hpp"

namespace mpm::history {

/// A row for each CV and channel of each period; cells of what is not known, or is none of a CV or
/// of a channel, are empty. Times are UTC in ISO 8601, or seconds where they are no dates.
[[nodiscard]] std::string to_csv(const Trend& trend);

}  // namespace mpm::history
