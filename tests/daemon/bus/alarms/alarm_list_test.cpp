#include "daemon/bus/alarms/alarm_list.hpp"

#include <catch2/catch.hpp>

namespace mpm::bus {
namespace {

TEST_CASE("what is normal does not stand, what is silenced does") {
  AlarmList list;
  const auto add = [&](const char* unit, const char* cv, bool retain) {
    AlarmStateRecord& alarm = list.channels[{unit, cv, "u1"}];
    alarm.unit = unit;
    alarm.cv = cv;
    alarm.view.retain = retain;
  };
  add("a", "y1", true);
  add("a", "y2", false);
  add("b", "y1", true);
  CHECK(list.standing("").size() == 2);
  REQUIRE(list.standing("a").size() == 1);
  CHECK(list.standing("a")[0]->cv == "y1");
  CHECK(list.standing("c").empty());
}

}  // namespace
}  // namespace mpm::bus
