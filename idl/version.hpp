#pragma once

#include <string>

namespace mpm::idl {

/// "mpmd 0.1.0 (Eigen 3.4.0, Cyclone DDS 0.10.2)": of what this was built with.
[[nodiscard]] std::string version_text(const std::string& program);

}  // namespace mpm::idl
