#pragma once

#include <string>

namespace mpm::host {

/// Log to stderr: for people on a terminal, with journald's `<n>` level prefixes elsewhere. DDS
/// messages go the same way. `level`: trace, debug, info, warning, error, critical, off.
void set_up_logging(const std::string& level);

}  // namespace mpm::host
