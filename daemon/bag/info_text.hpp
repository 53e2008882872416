#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "daemon/bag/info.hpp"

namespace mpm::bag {

/// For programs; docs/recording.md tells the keys.
[[nodiscard]] nlohmann::ordered_json to_json(const FileInfo& info);
/// For people.
[[nodiscard]] std::string to_text(const FileInfo& info);

/// "50.0 min"
[[nodiscard]] std::string duration_text(double seconds);
/// "508.5 kB"
[[nodiscard]] std::string bytes_text(std::uint64_t bytes);

}  // namespace mpm::bag
