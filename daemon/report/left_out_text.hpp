#pragma once

#include <string>

#include "config/unit_config.hpp"
#include "core/identify/evidence/jumps.hpp"

namespace mpm::report {

/// "1 value left out, far beyond all that the signal had been and back at once, of y3 (1)"; empty
/// where none was.
[[nodiscard]] std::string left_out_text(const config::UnitConfig& unit, const JumpTally& jumps);

}  // namespace mpm::report
