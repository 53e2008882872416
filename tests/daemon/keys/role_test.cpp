#include "daemon/keys/role.hpp"

#include <catch2/catch.hpp>

namespace mpm::keys {
namespace {

TEST_CASE("who monitors writes what monitors say, and nothing of the process") {
  const Permissions monitor = permissions_of(Role::kMonitor);
  const std::vector<std::string_view> outputs = {
      "mpm/channel_status", "mpm/alarm",       "mpm/alarm_event",   "mpm/controller_alarm",
      "mpm/health",         "mpm/performance", "mpm/command_reply", "mpm/role"};
  CHECK(monitor.writes == outputs);
  CHECK(permissions_of(Role::kViewer).writes.empty());
  CHECK(permissions_of(Role::kOperator).writes == std::vector<std::string_view>{"mpm/command"});
  CHECK(permissions_of(Role::kGateway).writes ==
        std::vector<std::string_view>{"mpm/layout", "mpm/mv", "mpm/dv", "mpm/cv", "mpm/prediction",
                                      "mpm/setpoint", "mpm/raw"});
}

}  // namespace
}  // namespace mpm::keys
