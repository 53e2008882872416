#pragma once

#include <cstddef>
#include <string>

#include "config/unit_config.hpp"
#include "daemon/live/sample_log.hpp"

namespace mpm::live {

/// What the samples of a unit mean, as text: tags and their order, the sample time and, where
/// predictions come with them, the model that these are of. Those that were kept with another
/// meaning tell nothing of the unit as it is now.
[[nodiscard]] std::string meaning_of(const config::UnitConfig& unit);

/// The log of a unit's samples in `folder`, of as many as its statistics and a diagnosis rest on;
/// of large units, or one of many (`units`, all of the process), less: all of it is to be judged
/// again before the service is ready.
[[nodiscard]] SampleLog samples_of(const config::UnitConfig& unit, std::size_t units,
                                   const std::string& folder);

}  // namespace mpm::live
