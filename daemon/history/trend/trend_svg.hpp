#pragma once

#include <string>

#include "daemon/history/trend/changes.hpp"

namespace mpm::history {

/// A picture that needs nothing else: a column of panels for each CV, its prediction errors on top
/// and a channel below for each input, and what changed in words. `zone`: as in `to_text`.
[[nodiscard]] std::string to_svg(const Trend& trend, const Findings& findings,
                                 const files::TimeZone* zone);

}  // namespace mpm::history
