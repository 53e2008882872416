#pragma once

#include <string>

namespace mpm::host {

/// "mpmd 0.1.0 (Eigen 3.4.0, Cyclone DDS 0.10.2)"
[[nodiscard]] std::string version_text(const std::string& program);

}  // namespace mpm::host
