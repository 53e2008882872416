#pragma once

#include <string>

namespace mpm::test {

/// Reads `path` in every way that there is and mends it into `scratch`, which goes away. Bad input
/// may only end in config::InputError, which is kept inside; anything else comes out. The mended
/// file must be whole.
void exercise_mcap(const std::string& path, const std::string& scratch);

}  // namespace mpm::test
