#pragma once

#include <filesystem>

#include "tests/hidden/hidden_case.hpp"

namespace mpm::hidden {

/// The case as files of `folder`, for programs that know nothing of it: CLASS_PLANT_SEED.csv, wide,
/// in its own unit's tags; .yaml, the unit file, its model the controller's; .json, a line:
/// class, and of each effect cause, kind, cv and mv (null where none). Throws std::runtime_error
/// where one cannot be written.
void write_case(const HiddenCase& hidden, const std::filesystem::path& folder);

}  // namespace mpm::hidden
