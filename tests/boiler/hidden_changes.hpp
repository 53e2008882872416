#pragma once

#include <string>

#include "tests/boiler/live_run.hpp"

namespace mpm::boiler {

/// What a finding has to do with what a scenario hides: "right", the reason why it comes near, or
/// "wrong". `healthy`: the diagnosis of a run in which nothing is hidden.
[[nodiscard]] std::string judged(const std::string& scenario, const Json& finding,
                                 const Json& healthy);

}  // namespace mpm::boiler
