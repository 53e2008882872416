#pragma once

namespace mpm::idl {

/// "0.10.2": of the DDS that this was built with.
[[nodiscard]] const char* cyclone_version();

}  // namespace mpm::idl
