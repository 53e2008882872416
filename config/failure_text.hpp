#pragma once

#include <string>

namespace mpm::config {

/// What the system says of an `errno`; where something is not permitted, with the user to whom:
/// who reads it may be another one, as root is beside a service.
[[nodiscard]] std::string failure_text(int error);

}  // namespace mpm::config
