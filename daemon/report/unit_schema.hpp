#pragma once

#include <nlohmann/json.hpp>

namespace mpm::report {

/// JSON Schema (draft 2020-12) of a unit file, for editors. Keys, kinds and ranges of settings come
/// from the declarations that the loader reads by (config/fields.hpp); what holds between several
/// keys, and whether a tag is one, says `mpmd --check` alone.
[[nodiscard]] nlohmann::ordered_json unit_schema();

}  // namespace mpm::report
