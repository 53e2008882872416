#pragma once

#include <string>
#include <vector>

namespace mpm::app {

/// What the user should know, on standard error: wrapped for a terminal, one line each for what
/// reads it there otherwise. `about` and a colon stand before each, if there is any and
/// it does not stand there yet.
void tell_notices(const std::vector<std::string>& notices, const std::string& about = {});

}  // namespace mpm::app
