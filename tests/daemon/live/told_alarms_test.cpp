#include "daemon/live/told_alarms.hpp"

#include <catch2/catch.hpp>

namespace mpm::live::told_alarms_test {
namespace {

AlarmRecord change(AlarmChange to, std::int64_t interval) {
  AlarmRecord record;
  record.mv = "u";
  record.cv = "y";
  record.to = to;
  record.interval = interval;
  return record;
}

TEST_CASE("what stands for who reads is what was told last, by event or state") {
  ToldAlarms told;
  CHECK_FALSE(told.active("u", "y").has_value());
  // A monitor that took over has told states alone.
  told.states[{"u", "y"}] = AlarmStateRecord(change(AlarmChange::kActive, 10));
  CHECK(told.active("u", "y") == true);
  CHECK_FALSE(told.active("u", "z").has_value());
  // One that fell silent between the two has told the event alone.
  told.events[{"u", "y"}] = change(AlarmChange::kCleared, 20);
  CHECK(told.active("u", "y") == false);
  told.states[{"u", "y"}] = AlarmStateRecord(change(AlarmChange::kCleared, 20));
  told.events[{"u", "y"}] = change(AlarmChange::kDiagnosed, 30);
  CHECK(told.active("u", "y") == true);
}

TEST_CASE("a standing is as its view tells, whatever silences it") {
  for (const Annunciation annunciation : {Annunciation::kNormal, Annunciation::kUnacknowledged,
                                          Annunciation::kAcknowledged, Annunciation::kReturned})
    for (const Shelving shelving : {Shelving::kUnshelved, Shelving::kTimed}) {
      AlarmStanding standing;
      standing.annunciation = annunciation;
      standing.shelving = shelving;
      standing.unshelve_time_ns = 5;
      standing.out_of_service = annunciation == Annunciation::kReturned;
      standing.active_time_ns = 3;
      standing.ack_time_ns = 4;
      standing.user = "ann";
      standing.comment = "seen";
      const ControlRoomView view(standing, NotificationClass::kAlarm, AlarmPriority::kHigh);
      const bool active = annunciation == Annunciation::kUnacknowledged ||
                          annunciation == Annunciation::kAcknowledged;
      const AlarmStanding back = standing_of(view, active);
      CHECK(back.annunciation == annunciation);
      CHECK(back.shelving == shelving);
      CHECK(back.unshelve_time_ns == 5);
      CHECK(back.out_of_service == standing.out_of_service);
      CHECK(back.active_time_ns == 3);
      CHECK(back.ack_time_ns == 4);
      CHECK(back.user == "ann");
      CHECK(back.comment == "seen");
    }
}

}  // namespace
}  // namespace mpm::live::told_alarms_test
