#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daemon/bag/list.hpp"

namespace mpm::bag {

/// For programs: an array; docs/recording.md tells the keys.
[[nodiscard]] nlohmann::ordered_json to_json(const std::vector<ListedRecording>& list);
/// For people: one line each.
[[nodiscard]] std::string to_text(const std::vector<ListedRecording>& list);

}  // namespace mpm::bag
