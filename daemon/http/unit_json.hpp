#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "daemon/http/unit_store.hpp"

namespace mpm::http {

using Json = nlohmann::ordered_json;

/// How a channel is to be shown: "mismatch" where it matters, "watch" where something is off that
/// is too small to matter, or where an alarm stands that it bears out no more, "match",
/// "undetermined".
[[nodiscard]] std::string_view channel_state(const ChannelRecord& channel);

/// The unit's card: verdicts, indices, health. `attention`: 4 alarms, 3 blind, 2 doubtful data or a
/// mismatch without an alarm, 1 not settled, 0 well.
[[nodiscard]] Json overview_json(const UnitStore& store);
/// Everything of a unit but its past.
[[nodiscard]] Json unit_json(const UnitStore& store);
/// The alarms that are not normal, the youngest first. What the plant alone has silenced is among
/// them only where it would call.
[[nodiscard]] Json alarms_json(const UnitStore& store);
/// Of each input of a CV: correlation against lag, and what chance alone leaves within.
[[nodiscard]] Json correlations_json(const UnitStore& store, int cv);

}  // namespace mpm::http
