#pragma once

#include <optional>
#include <string>

namespace mpm::config {

/// All that is in a regular file; or nothing, and `why`, in the system's words: also where reading
/// fails halfway. Never waits: what is a pipe or a device is not read.
[[nodiscard]] std::optional<std::string> read_whole_file(const std::string& path, std::string& why);

}  // namespace mpm::config
