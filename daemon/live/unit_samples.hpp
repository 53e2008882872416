#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "config/unit_config.hpp"

namespace mpm::live {

/// What the samples of a unit mean, as text: tags and their order, the sample time and, where
/// predictions come with them, the model that these are of. Those that were kept with another
/// meaning tell nothing of the unit as it is now.
[[nodiscard]] std::string meaning_of(const config::UnitConfig& unit);

/// To which program and which unit, with all that its file says, a state belongs: another program
/// may have other classes, another file other numbers.
[[nodiscard]] std::string owner_of_state(const config::UnitConfig& unit);

/// Where and how a unit's samples and states are kept.
struct UnitSamples {
  std::string folder, meaning, owner;
  std::uint64_t keep = 1;                  ///< intervals
  std::uint64_t files_between_states = 1;  ///< of the log
};

/// In `folder`, of as many samples as the unit's statistics and a diagnosis rest on; of large
/// units, or one of many (`units`, all of the process), less: where no state is of use all of it is
/// to be judged again before the service is ready. States as often as keeps that short where one
/// is.
[[nodiscard]] UnitSamples samples_of(const config::UnitConfig& unit, std::size_t units,
                                     const std::string& folder);

}  // namespace mpm::live
