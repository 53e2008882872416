#pragma once

#include <string>

namespace mpm::host {

/// Log to stderr: with journald's `<n>` level prefixes where that is what reads it, with times and
/// levels for people elsewhere. DDS messages go the same way. `level`: trace, debug, info, warning,
/// error, critical, off.
void set_up_logging(const std::string& level);

}  // namespace mpm::host
