#pragma once

#include <nlohmann/json.hpp>

#include "mpm.h"

namespace mpm::bus {

/// What a sample of an input, or of mpm/role, holds, for `mpm echo`; what else the monitor says is
/// in daemon/report/record_json.hpp.
[[nodiscard]] nlohmann::ordered_json json_of(const mpm_Sample& sample);
[[nodiscard]] nlohmann::ordered_json json_of(const mpm_Layout& sample);
[[nodiscard]] nlohmann::ordered_json json_of(const mpm_Role& sample);

/// The same, or a record, as lines `name: value` for people, nested values indented.
[[nodiscard]] std::string yaml_text(const nlohmann::ordered_json& json);

}  // namespace mpm::bus
