#pragma once

#include <vector>

#include "config/unit_config.hpp"
#include "core/monitor/lost_signals.hpp"
#include "daemon/bus/trouble.hpp"

namespace mpm::live {

/// What health says of signals without a usable value: a trouble per cause, which names the tags.
/// None of a kind of which `others` say more: where nothing comes, or nothing that can be taken,
/// its values are not what is bad.
[[nodiscard]] std::vector<bus::Trouble> lost_troubles(const config::UnitConfig& unit,
                                                      const std::vector<LostSignal>& lost,
                                                      const std::vector<bus::Trouble>& others);

}  // namespace mpm::live
