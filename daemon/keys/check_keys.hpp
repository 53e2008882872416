#pragma once

#include <chrono>
#include <ctime>
#include <vector>

#include "config/finding.hpp"
#include "config/unit_config.hpp"
#include "daemon/keys/role.hpp"

namespace mpm::keys {

/// So long before keys expire it is told.
inline constexpr std::chrono::days kNotice{30};

/// What is wrong with the keys that a unit file (or an option) names for `role`, at the place that
/// names them; empty where `settings` names none. A warning where they expire soon. Never throws on
/// what the files hold.
[[nodiscard]] std::vector<config::Finding> check_keys(const config::DdsSettings& settings,
                                                      Role role, std::time_t now);

}  // namespace mpm::keys
