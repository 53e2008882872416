#pragma once

#include <array>
#include <chrono>

#include "config/unit_config.hpp"
#include "core/signal/aligner.hpp"

/// How the samples of a unit become frames: the same for the daemon and for a recording.
namespace mpm::files {

/// Which kinds a frame of the unit cannot do without. A kind of which all is calculated does not
/// come. No verdict needs set-points, so they are among them only where something is calculated
/// from one; aux signals are in files only.
[[nodiscard]] std::array<bool, kSignalKindCount> needed_kinds(const config::UnitConfig& unit);
/// Besides, set-points are welcome.
[[nodiscard]] AlignerSettings aligner_settings(const config::UnitConfig& unit);

/// How long a frame may be awaited while something else of the unit is there.
[[nodiscard]] std::chrono::nanoseconds frame_patience(const config::UnitConfig& unit);

}  // namespace mpm::files
