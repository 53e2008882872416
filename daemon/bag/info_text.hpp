#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/bag/info.hpp"

namespace mpm::bag {

/// For programs; docs/recording.md tells the keys.
[[nodiscard]] nlohmann::ordered_json to_json(const FileInfo& info);
/// For people.
[[nodiscard]] std::string to_text(const FileInfo& info);

}  // namespace mpm::bag
