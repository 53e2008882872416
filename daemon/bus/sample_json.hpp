#pragma once

#include <nlohmann/json.hpp>

#include "mpm.h"

namespace mpm::bus {

/// What a sample holds, for `mpm echo`. Status, alarms and health as the journal and `mpm watch
/// --json` write them.
[[nodiscard]] nlohmann::ordered_json json_of(const mpm_Sample& sample);
[[nodiscard]] nlohmann::ordered_json json_of(const mpm_Layout& sample);
[[nodiscard]] nlohmann::ordered_json json_of(const mpm_ChannelStatus& sample);
[[nodiscard]] nlohmann::ordered_json json_of(const mpm_Alarm& sample);
[[nodiscard]] nlohmann::ordered_json json_of(const mpm_AlarmEvent& sample);
[[nodiscard]] nlohmann::ordered_json json_of(const mpm_Health& sample);

/// The same as lines `name: value` for people, nested values indented.
[[nodiscard]] std::string yaml_text(const nlohmann::ordered_json& json);

}  // namespace mpm::bus
