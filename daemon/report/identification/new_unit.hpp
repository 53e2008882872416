#pragma once

#include <string>

#include "daemon/report/identification/identification_run.hpp"

namespace mpm::report {

/// The unit file `text` with the identified model in place of the one it had, all else as it was,
/// comments too. Throws std::logic_error where that would not load back.
[[nodiscard]] std::string new_unit_yaml(const IdentificationRun& run, const std::string& text);

}  // namespace mpm::report
