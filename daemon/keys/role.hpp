#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "core/text/words.hpp"

namespace mpm::keys {

/// What a participant is on a secured bus. Each program of ours takes the one that it needs.
enum class Role : unsigned char {
  kMonitor,   ///< mpmd: reads everything, writes what a monitor says and nothing else
  kGateway,   ///< the control system's side: writes inputs and layouts
  kOperator,  ///< a screen that may command: reads everything, writes commands
  kViewer,    ///< reads everything, writes nothing
};
/// Names of their folders.
[[nodiscard]] constexpr auto words_of(Role) {
  return std::array{"monitor", "gateway", "operator", "viewer"};
}
inline constexpr std::array kRoles = {Role::kMonitor, Role::kGateway, Role::kOperator,
                                      Role::kViewer};

/// Topics, "*" standing for the rest of a name.
struct Permissions {
  std::vector<std::string_view> reads, writes;
};
[[nodiscard]] Permissions permissions_of(Role role);

}  // namespace mpm::keys
