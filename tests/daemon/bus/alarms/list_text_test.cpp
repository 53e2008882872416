#include "daemon/bus/alarms/list_text.hpp"

#include <catch2/catch.hpp>

#include "tests/idl/fixed_records.hpp"

namespace mpm::bus {
namespace {

const report::Layout kWide{200, false};

AlarmList list() {
  AlarmList list;
  ControllerAlarmRecord& controller = list.controllers["shell"];
  controller.unit = "shell";
  controller.state = AlarmState::kActive;
  controller.view.alarm_state = AlarmWord::kUnacknowledged;
  controller.view.retain = true;
  controller.view.active_time_ns = 1'772'344'800'000'000'000;
  controller.view.message = "the model of u1 -> y1 does not match the plant";
  const auto add = [&](const char* cv, const ControlRoomView& view) {
    AlarmStateRecord& alarm = list.channels[{"shell", cv, "u1"}];
    alarm.unit = "shell";
    alarm.mv = "u1";
    alarm.cv = cv;
    alarm.view = view;
  };
  ControlRoomView shelved;
  shelved.alarm_state = AlarmWord::kShelved;
  shelved.shelving_state = Shelving::kTimed;
  shelved.unshelve_time_ns = 1'772'344'800'000'000'000;
  shelved.retain = true;
  shelved.client_user_id = "ann";
  shelved.comment = "known\x1b[2J";
  add("y1", shelved);
  add("y2", {});
  return list;
}

TEST_CASE("the controller's alarm comes first, then what stands or is silenced of its channels") {
  CHECK(alarm_list_text(list(), "", false, kWide) ==
        "shell  unacknowledged since 2026-03-01 06:00:00 UTC: the model of u1 -> y1 does not match "
        "the plant\n"
        "  u1 -> y1  shelved until 2026-03-01 06:00:00 UTC [ann: known\\x1b[2J]\n");
}

TEST_CASE("all alarms are those that are normal, too, and other units' are left out") {
  CHECK_THAT(alarm_list_text(list(), "", true, kWide),
             Catch::Matchers::EndsWith("  u1 -> y2  normal\n"));
  CHECK(alarm_list_text(list(), "other", true, kWide).empty());
}

TEST_CASE("colour comes only where it is wanted") {
  CHECK(alarm_list_text(list(), "", false, kWide).find("\x1b[3") == std::string::npos);
  CHECK(alarm_list_text(list(), "", false, {200, true}).find('\x1b') != std::string::npos);
}

}  // namespace
}  // namespace mpm::bus
