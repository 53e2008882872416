#pragma once

#include <optional>
#include <string>
#include <variant>

#include "core/alarm/alarm_command.hpp"

namespace mpm::http {

/// Longest texts that are taken, bytes.
inline constexpr std::size_t kLongestUser = 100, kLongestComment = 1000;
/// A command from its JSON, or in words what is wrong with it.
[[nodiscard]] std::variant<AlarmCommand, std::string> parse_command(const std::string& body);

}  // namespace mpm::http
