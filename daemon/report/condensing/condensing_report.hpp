#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/identify/fit/condense.hpp"

namespace mpm::report {

/// What of a long recording was used, in one sentence without its full stop; empty where it is all
/// of it as it was. `samples`: that are left.
[[nodiscard]] std::string condensing_text(const Condensing& how, Eigen::Index samples);

/// The same as report.json and model.json have it: samples_given, averaged (so many into one),
/// stretches (0: all of the recording).
[[nodiscard]] nlohmann::ordered_json condensing_json(const Condensing& how);

}  // namespace mpm::report
