#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/recording/info.hpp"

namespace mpm::recording {

/// For programs; docs/recording.md tells the keys.
[[nodiscard]] nlohmann::ordered_json to_json(const FileInfo& info);
/// For people.
[[nodiscard]] std::string to_text(const FileInfo& info);

}  // namespace mpm::recording
