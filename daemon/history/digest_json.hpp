#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/history/digest.hpp"

namespace mpm::history {

/// Lines of a journal, without their ends: {"record": "journal", ...} and {"record": "digest",
/// ...}.
[[nodiscard]] std::string line_of(const UnitHead& head);
[[nodiscard]] std::string line_of(const std::string& unit, const Digest& digest);

/// The way back, from the line as JSON. Throw nlohmann::json::exception where something is missing
/// or of another kind; what they do not know they leave out.
[[nodiscard]] UnitHead head_of(const nlohmann::json& line);
[[nodiscard]] Digest digest_of(const nlohmann::json& line);

}  // namespace mpm::history
