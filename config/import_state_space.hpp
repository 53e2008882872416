#pragma once

#include <string>
#include <vector>

#include "config/finding.hpp"
#include "config/unit_config.hpp"

namespace mpm::config {

/// Reads `{"A": [[..]], "B": .., "C": .., "D": .., "x0": [..]}` (D and x0 may be left out) into the
/// unit's model, as `state_space:` of a unit file is. Where the file also has "sample_time" (s),
/// "inputs" or "outputs" (tags), they must be the unit's, in its order. Returns what is wrong, with
/// places.
[[nodiscard]] std::vector<Finding> import_state_space(const std::string& path, UnitConfig& config);

}  // namespace mpm::config
