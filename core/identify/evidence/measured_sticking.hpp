#pragma once

#include <vector>

#include "core/identify/fit/recording.hpp"

namespace mpm {

/// Of each input whose valve is measured among the aux signals, and sticks, how: where a sticking
/// valve would go next explains most of what the position's own past and the command's leave. No
/// model is asked. Position and command in one unit, and no further apart than the valve sticks.
/// What was recorded by exception stands still and jumps as if it stuck: whether the plant feels
/// it, CVs must tell.
[[nodiscard]] std::vector<MeasuredSticking> measured_sticking(const Recording& recording);

}  // namespace mpm
