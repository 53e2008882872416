#include "core/alarm/alarm_desk.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace mpm::alarm_desk_test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr double kSampleTime = 2.0;  // s

struct Unit {
  explicit Unit(const AlarmHandling& handling = {})
      : desk(handling, kSampleTime, {{"u1", "y1"}, {"u2", "y1"}, {"u1", "y2"}}) {}

  AlarmDesk desk;
  std::vector<AlarmDesk::Observation> channels{3};
  std::int64_t sample = 0;
  int controller_alarms = 0;  // annunciated

  [[nodiscard]] AlarmMoment now() const { return {2 * kSecond * sample, 2 * kSecond * sample}; }
  void run(int samples) {
    for (int i = 0; i < samples; ++i) {
      ++sample;
      desk.observe(channels, now());
      for (const AlarmDesk::Occurrence& occurrence : desk.occurred())
        if (occurrence.alarm == AlarmDesk::kController &&
            occurrence.what == AlarmOccurrence::kActive)
          ++controller_alarms;
      desk.tick(now());
    }
  }
  CommandReply apply(AlarmAction action, const std::string& mv = "", const std::string& cv = "",
                     double duration_s = 0.0) {
    AlarmCommand command;
    command.mv = mv;
    command.cv = cv;
    command.action = action;
    command.duration_s = duration_s;
    return desk.apply(command, now());
  }
  [[nodiscard]] bool controller() const { return desk.active(AlarmDesk::kController); }
  [[nodiscard]] std::string word(int alarm) const {
    return std::string(to_string(desk.standing(alarm).word()));
  }
};

TEST_CASE("all channels' alarms of a shift are one of the controller") {
  Unit unit;
  const int shift = 8 * 3600 / 2;  // samples
  for (int i = 0; i < 20; ++i) {
    unit.channels[static_cast<std::size_t>(i % 3)].active = true;
    unit.run(shift / 100);
    unit.channels[static_cast<std::size_t>(i % 3)].active = false;
    unit.run(shift / 50);
  }
  CHECK(unit.controller());
  CHECK(unit.controller_alarms == 1);
  unit.run(shift);
  CHECK_FALSE(unit.controller());
  CHECK(unit.word(AlarmDesk::kController) == "returned_unacknowledged");
}

TEST_CASE("the controller's alarm waits for its on-delay") {
  AlarmHandling handling;
  handling.controller.on_delay_s = 20.0;
  Unit unit(handling);
  unit.channels[1].active = true;
  unit.run(9);
  CHECK_FALSE(unit.controller());
  unit.run(1);
  CHECK(unit.controller());
}

TEST_CASE("silencing the last standing channel ends the controller's alarm at once") {
  Unit unit;
  unit.channels[0].active = unit.channels[2].active = true;
  unit.run(1);
  CHECK(unit.controller());
  CHECK(unit.desk.standing_channels() == 2);
  CHECK(unit.apply(AlarmAction::kShelve, "u1", "y1", 3600.0).accepted);
  CHECK(unit.controller());
  CHECK(unit.apply(AlarmAction::kOutOfService, "u1", "y2").accepted);
  CHECK_FALSE(unit.controller());
  CHECK(unit.apply(AlarmAction::kInService, "u1", "y2").accepted);
  unit.run(1);
  CHECK(unit.controller());
}

TEST_CASE(
    "what the controller's alarm was acknowledged for calls nobody anew when a silence ends") {
  const bool acknowledged = GENERATE(true, false);
  const bool another = GENERATE(false, true);  // channel rises behind the shelf
  const bool gone = GENERATE(false, true);     // and back, meanwhile
  Unit unit;
  unit.channels[0].active = true;
  unit.run(1);
  if (acknowledged) CHECK(unit.apply(AlarmAction::kAcknowledge).accepted);
  CHECK(unit.apply(AlarmAction::kShelve, "u1", "y1", 100.0).accepted);
  CHECK_FALSE(unit.controller());
  if (gone) {
    unit.channels[0].active = false;
    unit.run(2);
    unit.channels[0].active = true;
    unit.run(2);
  }
  unit.run(100);
  if (another) {
    unit.channels[2].active = true;
    CHECK(unit.apply(AlarmAction::kShelve, "u1", "y1", 100.0).accepted);
  }
  unit.run(2);
  CHECK(unit.controller());
  CHECK(unit.word(AlarmDesk::kController) ==
        (acknowledged && !another && !gone ? "acknowledged" : "unacknowledged"));
}

TEST_CASE("a gap in the data is no event, a controller that is off suppresses by design") {
  Unit unit;
  unit.channels[0].active = true;
  unit.run(1);
  for (auto& channel : unit.channels) channel.meaningful = false;
  unit.run(9);
  CHECK(unit.word(0) == "unacknowledged");
  for (auto& channel : unit.channels) channel.meaningful = true;
  unit.run(1);
  for (auto& channel : unit.channels) channel.meaningful = false;
  unit.run(10);
  CHECK(unit.word(0) == "suppressed");
  CHECK(unit.word(AlarmDesk::kController) == "suppressed");
  CHECK(unit.controller());  // behind it
  unit.run(100'000);
  for (auto& channel : unit.channels) channel.meaningful = true;
  unit.run(10);
  CHECK(unit.word(AlarmDesk::kController) == "unacknowledged");
  CHECK(unit.controller_alarms == 1);  // the same one still
}

TEST_CASE("one CV without data for a while does not make the controller's alarm come twice") {
  Unit unit;
  unit.channels[2].active = true;
  unit.run(1);
  unit.channels[2].meaningful = false;
  unit.run(50'000);
  CHECK(unit.word(2) == "suppressed");
  CHECK(unit.controller());
  unit.channels[2].meaningful = true;
  unit.run(20);
  CHECK(unit.controller_alarms == 1);
}

TEST_CASE("a command for what the unit has not is refused in words") {
  Unit unit;
  CHECK(unit.apply(AlarmAction::kAcknowledge, "u9", "y1").text ==
        "this unit has no channel u9 -> y1");
  CHECK_FALSE(unit.apply(AlarmAction::kAcknowledge, "u1", "").accepted);
  CHECK(unit.desk.occurred().empty());
}

TEST_CASE("what a restart restores is told by the names of the channel") {
  Unit unit;
  AlarmStanding before;
  before.out_of_service = true;
  CHECK(unit.desk.restore("u2", "y1", before));
  CHECK_FALSE(unit.desk.restore("u9", "y1", before));
  CHECK(unit.word(1) == "out_of_service");
}

}  // namespace
}  // namespace mpm::alarm_desk_test
