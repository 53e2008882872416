#include "daemon/bus/plugin_status.hpp"

#include <catch2/catch.hpp>

// Codes, and the form of the line, as the Monitoring Plugins guidelines have them:
// 'label'=value[unit];[warn];[crit];[min];[max].
namespace mpm::bus {
namespace {

MonitorWord word(const char* unit, const char* state, std::uint32_t alarms = 0,
                 double age_s = 0.5) {
  return {unit, state, "", alarms, age_s, false};
}

}  // namespace

TEST_CASE("units that are well are OK, with their performance data") {
  const PluginStatus status =
      plugin_status({word("a", "normal"), word("b", "normal")}, AgeLimits(), "domain 0");
  CHECK(status.code == 0);
  CHECK(status.line ==
        "MPM OK: 2 units, 0 alarms | 'a alarms'=0;0 'a age'=0.5s;5;30 'a state'=0;0;1"
        " 'b alarms'=0;0 'b age'=0.5s;5;30 'b state'=0;0;1");
}

TEST_CASE("the worst unit decides") {
  const AgeLimits limits;
  CHECK(
      plugin_status({word("a", "normal"), word("b", "maintenance_required", 2)}, limits, "").code ==
      1);
  CHECK(plugin_status({word("a", "normal", 1)}, limits, "").code == 1);
  CHECK(plugin_status({word("a", "function_check")}, limits, "").code == 1);
  CHECK(plugin_status({word("a", "out_of_specification"), word("b", "failure")}, limits, "").code ==
        2);
  CHECK(plugin_status({word("a", "normal", 0, 5.0)}, limits, "").code == 1);
  CHECK(plugin_status({word("a", "normal", 0, 30.0)}, limits, "").code == 2);
  MonitorWord gone = word("a", "normal");
  gone.gone = true;
  CHECK(plugin_status({gone}, limits, "").code == 2);
}

TEST_CASE("a monitor that is not there is critical") {
  const PluginStatus nobody = plugin_status({}, AgeLimits(), "domain 3");
  CHECK(nobody.code == 2);
  CHECK(nobody.line == "MPM CRITICAL: no monitor on domain 3");
  const PluginStatus absent =
      plugin_status({word("a", ""), word("b", "normal")}, AgeLimits(), "domain 3");
  CHECK(absent.code == 2);
  MonitorWord ignored = word("a", "");
  ignored.place = "domain 3 (CYCLONEDDS_URI is set, but not used)";
  CHECK(plugin_status({ignored}, {}, "")
            .line.find("a: no monitor on domain 3 (CYCLONEDDS_URI is set, but not used) |") !=
        std::string::npos);
  CHECK(absent.line.find("MPM CRITICAL: a: no monitor | 'a alarms'=U 'a age'=U 'a state'=2;0;1") ==
        0);
}

TEST_CASE("no name breaks the line") {
  MonitorWord odd = word("a|b'=\n", "failure");
  odd.detail = "x | y\nz";
  const std::string line = plugin_status({odd}, AgeLimits(), "").line;
  CHECK(std::count(line.begin(), line.end(), '|') == 1);
  CHECK(line.find('\n') == std::string::npos);
  CHECK(line.find("'a_b__") != std::string::npos);
}

TEST_CASE("no unit or detail of the bus gets to the terminal as it is") {
  MonitorWord odd = word("a\xff", "failure");
  odd.detail = "\x1b[31m\xc2\x9b\x7f";
  const std::string line = plugin_status({odd}, AgeLimits(), "").line;
  CHECK(line.find(
            "MPM CRITICAL: a\\xff: failure (\\x1b[31m\\u{9b}\\x7f), 0.5 s ago | 'a\\xff alarms'") ==
        0);
}

TEST_CASE("alarms that are silenced are told apart, and warn nobody") {
  MonitorWord one = word("a", "normal", 2);
  one.silenced_alarms = 2;
  one.detail = "2 silenced alarms";
  const PluginStatus silent = plugin_status({one, word("b", "normal")}, AgeLimits(), "");
  CHECK(silent.code == 0);
  CHECK(silent.line.find("MPM OK: 2 units, 2 silenced alarms | 'a alarms'=0;0 ") == 0);
  one.silenced_alarms = 1;
  one.state = "maintenance_required";
  one.detail = "1 alarm, 1 silenced";
  const PluginStatus calling = plugin_status({one}, AgeLimits(), "");
  CHECK(calling.code == 1);
  CHECK(calling.line.find("MPM WARNING: a: maintenance_required (1 alarm, 1 silenced), 0.5 s ago | "
                          "'a alarms'=1;0") == 0);
}

}  // namespace mpm::bus
