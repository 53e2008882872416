#pragma once

#include <functional>
#include <string>

namespace mpm::idl {

enum class LogLevel { kInfo, kWarning, kError };
using LogHandler = std::function<void(LogLevel, const std::string&)>;

/// Sends Cyclone's log of the whole process to `handler` instead of stderr. It is called from
/// Cyclone's threads, one call at a time. Anyone on the network can provoke a line per packet, so
/// only a few lines per period pass; a summary tells how many did not. An empty handler: silence.
void set_log_handler(LogHandler handler);

/// The last line that Cyclone logged since `set_log_handler`; may be empty.
[[nodiscard]] std::string last_log_line();

}  // namespace mpm::idl
