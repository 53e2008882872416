#include "daemon/http/unit_json.hpp"

#include <catch2/catch.hpp>

#include "tests/daemon/http/sample_board.hpp"

namespace mpm::http {
namespace {

TEST_CASE("a channel is shown by what it needs") {
  ChannelRecord channel = report::match("u", "y");
  CHECK(channel_state(channel) == "match");
  channel.alarm = AlarmState::kActive;
  CHECK(channel_state(channel) == "watch");
  channel = report::mismatch("u", "y");
  CHECK(channel_state(channel) == "mismatch");
  channel.material = false;
  CHECK(channel_state(channel) == "watch");
  channel.alarm = AlarmState::kActive;
  CHECK(channel_state(channel) == "mismatch");
  CHECK(channel_state(report::undetermined("u", "y", Reason::kNotExcited)) == "undetermined");
}

TEST_CASE("a card says how many and how well") {
  test::SampleBoard sample;
  CHECK(overview_json(sample.store())["attention"] == 1);
  CHECK(overview_json(sample.store())["matrix"][2] == Json({"undetermined", "undetermined"}));
  sample.show(false);
  Json card = overview_json(sample.store());
  CHECK(card["attention"] == 0);
  CHECK(card["kpi"]["service_factor"] == 0.75);
  CHECK(card["kpi"]["at_limits"].is_null());
  CHECK(card["kpi"]["determined"] == Approx(5.0 / 6.0));
  CHECK(card["matrix"].size() == 3);
  CHECK(card["matrix"][0] == Json({"match", "undetermined"}));
  sample.show(true);
  card = overview_json(sample.store());
  CHECK(card["attention"] == 4);
  CHECK(card["alarms"] == 1);
  CHECK(card["matrix"][0][0] == "mismatch");
}

TEST_CASE("what is blind is worse than what is doubtful") {
  test::SampleBoard sample;
  sample.show(false);
  sample.health.state = "out_of_specification";
  sample.feed().on_view({sample.channels, sample.alarms, sample.controller, sample.health,
                         sample.troubles, sample.performance});
  sample.fetch();
  CHECK(overview_json(sample.store())["attention"] == 2);
  sample.health.state = "failure";
  sample.feed().on_view({sample.channels, sample.alarms, sample.controller, sample.health,
                         sample.troubles, sample.performance});
  sample.fetch();
  CHECK(overview_json(sample.store())["attention"] == 3);
}

TEST_CASE("a unit's channels are told in words") {
  test::SampleBoard sample;
  sample.push(5);
  sample.troubles = {{"x", bus::Severity::kFailure, "no data"}};
  sample.show(true);
  const Json json = unit_json(sample.store());
  CHECK(json["inputs"][0]["tag"] == "FIC-101");
  CHECK(json["inputs"][2]["kind"] == "dv");
  CHECK(json["inputs"][0]["value"] == 50.0);
  CHECK(json["cvs"][1]["measured"] == 5.0);
  CHECK(json["cvs"][1]["setpoint"].is_null());
  CHECK(json["channels"][0]["text"] ==
        "gain +41 % (31 to 51; +0.041 t/h per %), time constant ok, dead time ok");
  CHECK(json["channels"][1]["text"] == "needs a gain error of 70 % to show; move FIC-101");
  CHECK(json["channels"][3]["modelled"] == false);
  CHECK(json["troubles"][0]["text"] == "no data");
  CHECK(json["alarms"].size() == 1);
}

TEST_CASE("alarms that are normal are not listed") {
  test::SampleBoard sample;
  sample.show(false);
  CHECK(alarms_json(sample.store()).empty());
  sample.show(true);
  const Json alarms = alarms_json(sample.store());
  REQUIRE(alarms.size() == 1);
  CHECK(alarms[0]["mv"] == "FIC-101");
  CHECK(alarms[0]["to"] == "active");
  CHECK(alarms[0]["text"].get<std::string>().find("gain +41 %") == 0);
}

TEST_CASE("what the plant silences is an alarm only where it would call") {
  test::SampleBoard sample;
  sample.show(true);
  const auto view = [](bool active, Shelving shelving = Shelving::kUnshelved) {
    AlarmStanding standing;
    standing.annunciation = active ? Annunciation::kUnacknowledged : Annunciation::kNormal;
    standing.suppressed_by_design = true;
    standing.shelving = shelving;
    return ControlRoomView(standing, NotificationClass::kAlert, AlarmPriority::kLow);
  };
  for (AlarmStateRecord& alarm : sample.alarms) alarm.view = view(alarm.to == AlarmChange::kActive);
  sample.controller.view = view(true);
  sample.controller.state = AlarmState::kActive;
  sample.alarms[1].view = view(false, Shelving::kTimed);  // by somebody, who may undo it
  const auto look = [&sample] {
    sample.feed().on_view({sample.channels, sample.alarms, sample.controller, sample.health,
                           sample.troubles, sample.performance});
    sample.fetch();
    return alarms_json(sample.store());
  };
  const Json alarms = look();
  CHECK(alarms.size() == 3);  // of the unit, the one that stands, and the shelved one
  CHECK(std::count_if(alarms.begin(), alarms.end(),
                      [](const Json& alarm) { return alarm["to"] == "active"; }) == 2);
  CHECK(alarms[0]["suppressed_by_design"] == true);
  CHECK(overview_json(sample.store())["silenced_alarms"] == 2);
  CHECK(overview_json(sample.store())["alarms"] == 0);
  sample.alarms[1].view = view(false);
  CHECK(look().size() == 2);
  CHECK(overview_json(sample.store())["silenced_alarms"] == 1);
}

TEST_CASE("who stands by says so") {
  test::SampleBoard sample;
  sample.show(false);
  CHECK(unit_json(sample.store())["speaks"] == true);
  sample.feed().on_view({sample.channels, sample.alarms, sample.controller, sample.health,
                         sample.troubles, sample.performance, false});
  sample.fetch();
  CHECK(unit_json(sample.store())["speaks"] == false);
  CHECK(overview_json(sample.store())["speaks"] == false);
}

TEST_CASE("correlations come with what chance leaves") {
  test::SampleBoard sample;
  sample.show(true);
  const Json json = correlations_json(sample.store(), 0);
  REQUIRE(json["inputs"].size() == 3);
  CHECK(json["inputs"][0]["values"] == Json({0.1, 0.5, 0.2}));
  CHECK(json["inputs"][0]["limit"] == Approx(1.96 / 20.0).epsilon(1e-3));
  CHECK(json["inputs"][1]["limit"].is_null());
}

}  // namespace
}  // namespace mpm::http
