#include "core/alarm/managed_alarm.hpp"

#include <catch2/catch.hpp>

namespace mpm::managed_alarm_test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

/// An alarm, a clock and what has occurred since it was last asked.
struct Bench {
  ManagedAlarm alarm;
  ManagedAlarm::Settings settings;
  std::int64_t wall_s = 1000;
  ManagedAlarm::Occurrences fresh;

  [[nodiscard]] AlarmMoment now() const { return {kSecond * (wall_s - 500), kSecond * wall_s}; }
  void observe(bool active, bool meaningful = true) {
    alarm.observe(active, meaningful, now(), settings, fresh);
  }
  void wait(std::int64_t seconds) {
    wall_s += seconds;
    alarm.tick(now(), settings, fresh);
  }
  CommandReply apply(AlarmAction action, double duration_s = 0.0, bool once = false) {
    AlarmCommand command;
    command.action = action;
    command.duration_s = duration_s;
    command.once = once;
    command.user = "ann";
    command.comment = "seen";
    return alarm.apply(command, now(), settings, fresh);
  }
  ManagedAlarm::Occurrences occurred() { return std::exchange(fresh, {}); }
  [[nodiscard]] std::string word() const { return std::string(to_string(alarm.standing().word())); }
};
using List = ManagedAlarm::Occurrences;
using enum AlarmOccurrence;

TEST_CASE("an alarm that nobody has seen waits after its cause has gone, where it latches") {
  Bench bench;
  bench.observe(true);
  CHECK(bench.word() == "unacknowledged");
  CHECK(bench.alarm.standing().active_time_ns == 500 * kSecond);
  bench.observe(false);
  CHECK(bench.word() == "returned_unacknowledged");
  CHECK(bench.apply(AlarmAction::kAcknowledge).accepted);
  CHECK(bench.word() == "normal");
  CHECK(bench.occurred() == List{kActive, kCleared, kAcknowledged});

  bench.settings.latching = false;
  bench.observe(true);
  bench.observe(false);
  CHECK(bench.word() == "normal");
}

TEST_CASE("a list shows what stands, what nobody has seen and what people have silenced") {
  Bench bench;
  CHECK_FALSE(bench.alarm.standing().listed());
  bench.observe(false, false);  // no data, and nothing there to be silent about
  CHECK(bench.word() == "suppressed");
  CHECK_FALSE(bench.alarm.standing().listed());
  for (const auto& [silence, end] :
       {std::pair(AlarmAction::kShelve, AlarmAction::kUnshelve),
        std::pair(AlarmAction::kSuppress, AlarmAction::kUnsuppress),
        std::pair(AlarmAction::kOutOfService, AlarmAction::kInService)}) {
    CHECK(bench.apply(silence, 60.0).accepted);
    CHECK(bench.alarm.standing().listed());
    CHECK(bench.apply(end).accepted);
    CHECK_FALSE(bench.alarm.standing().listed());
  }
  bench.observe(true, false);
  CHECK(bench.alarm.standing().listed());
  bench.observe(true, true);
  bench.observe(false, true);
  CHECK(bench.word() == "returned_unacknowledged");
  bench.observe(false, false);
  CHECK(bench.alarm.standing().listed());
}

TEST_CASE("who acknowledged an alarm, when and with which words is kept") {
  Bench bench;
  CHECK_FALSE(bench.apply(AlarmAction::kAcknowledge).accepted);
  CHECK(bench.alarm.standing().user.empty());
  bench.observe(true);
  CHECK(bench.apply(AlarmAction::kAcknowledge).accepted);
  CHECK(bench.alarm.standing().user == "ann");
  CHECK(bench.alarm.standing().comment == "seen");
  CHECK(bench.alarm.standing().ack_time_ns == 1000 * kSecond);
  CHECK_FALSE(bench.apply(AlarmAction::kAcknowledge).accepted);
  CHECK(bench.occurred() == List{kActive, kAcknowledged});
}

TEST_CASE("a shelved alarm comes back when its time is up, unacknowledged if nobody had seen it") {
  Bench bench;
  CHECK(bench.apply(AlarmAction::kShelve, 60.0).accepted);
  CHECK(bench.alarm.standing().unshelve_time_ns == 1060 * kSecond);
  bench.observe(true);
  CHECK(bench.word() == "shelved");
  bench.wait(59);
  CHECK(bench.word() == "shelved");
  bench.wait(1);
  CHECK(bench.word() == "unacknowledged");
  CHECK(bench.alarm.standing().unshelve_time_ns == 0);
  CHECK(bench.occurred() == List{kShelved, kActive, kUnshelved});
}

TEST_CASE("what came and went behind a shelf need not be seen by anybody") {
  Bench bench;
  CHECK(bench.apply(AlarmAction::kShelve, 60.0).accepted);
  bench.observe(true);
  bench.observe(false);
  bench.wait(60);
  CHECK(bench.word() == "normal");
}

TEST_CASE("an alarm shelved once comes back when it has cleared, or when the longest time is up") {
  Bench bench;
  bench.observe(true);
  CHECK(bench.apply(AlarmAction::kShelve, 0.0, true).accepted);
  CHECK(bench.word() == "shelved");
  bench.observe(false);
  CHECK(bench.word() == "normal");
  CHECK(bench.occurred() == List{kActive, kShelved, kCleared, kUnshelved});

  bench.observe(true);
  CHECK(bench.apply(AlarmAction::kShelve, 0.0, true).accepted);
  bench.wait(86400);
  CHECK(bench.word() == "unacknowledged");
}

TEST_CASE("nothing is shelved for longer than the unit allows, nor for no time at all") {
  Bench bench;
  bench.observe(true);
  (void)bench.occurred();
  for (const double duration : {0.0, -1.0, 86401.0, 1e300, std::nan("")})
    CHECK_FALSE(bench.apply(AlarmAction::kShelve, duration).accepted);
  CHECK(bench.word() == "unacknowledged");
  CHECK(bench.occurred().empty());
  CHECK(bench.apply(AlarmAction::kShelve, 86400.0).accepted);
}

TEST_CASE("three ways of silence are told apart, and end one by one") {
  Bench bench;
  bench.observe(true);
  CHECK(bench.apply(AlarmAction::kShelve, 60.0).accepted);
  CHECK(bench.apply(AlarmAction::kSuppress).accepted);
  CHECK(bench.apply(AlarmAction::kOutOfService).accepted);
  CHECK(bench.word() == "out_of_service");
  CHECK_FALSE(bench.apply(AlarmAction::kOutOfService).accepted);
  CHECK(bench.apply(AlarmAction::kInService).accepted);
  CHECK(bench.word() == "suppressed");
  CHECK(bench.apply(AlarmAction::kUnsuppress).accepted);
  CHECK(bench.word() == "shelved");
  CHECK(bench.apply(AlarmAction::kUnshelve).accepted);
  CHECK(bench.word() == "unacknowledged");
  CHECK_FALSE(bench.apply(AlarmAction::kUnshelve).accepted);
}

TEST_CASE("what the plant makes meaningless is suppressed, and no command can end that") {
  Bench bench;
  bench.observe(true);
  bench.observe(true, false);
  CHECK(bench.word() == "suppressed");
  CHECK_FALSE(bench.apply(AlarmAction::kUnsuppress).accepted);
  bench.observe(true);
  CHECK(bench.word() == "unacknowledged");
  CHECK(bench.occurred() == List{kActive, kSuppressed, kUnsuppressed});
  // Suppressed by command as well, it was so before and is so after: nothing occurs.
  CHECK(bench.apply(AlarmAction::kSuppress).accepted);
  (void)bench.occurred();
  bench.observe(true, false);
  bench.observe(true, true);
  CHECK(bench.occurred().empty());
}

TEST_CASE("what stands acknowledged for too long is announced anew") {
  Bench bench;
  bench.observe(true);
  CHECK(bench.apply(AlarmAction::kAcknowledge).accepted);
  bench.wait(1'000'000);
  CHECK(bench.word() == "acknowledged");  // never, unless the unit wants it
  bench.settings.realarm_s = 3600.0;
  CHECK_FALSE(bench.apply(AlarmAction::kAcknowledge).accepted);
  bench.wait(1);
  CHECK(bench.word() == "unacknowledged");
  CHECK(bench.apply(AlarmAction::kAcknowledge).accepted);
  bench.wait(3599);
  CHECK(bench.word() == "acknowledged");
  bench.wait(1);
  CHECK(bench.word() == "unacknowledged");
}

TEST_CASE("a restart keeps what people have done, and what nobody has seen") {
  Bench before;
  before.observe(true);
  CHECK(before.apply(AlarmAction::kShelve, 60.0).accepted);
  Bench after;
  after.alarm.restore(before.alarm.standing(), after.settings);
  CHECK(after.word() == "shelved");
  after.wait(60);
  CHECK(after.word() == "returned_unacknowledged");  // its cause is to be found anew
  after.observe(true);
  CHECK(after.word() == "unacknowledged");

  CHECK(after.apply(AlarmAction::kAcknowledge).accepted);
  Bench later;
  later.alarm.restore(after.alarm.standing(), later.settings);
  CHECK(later.word() == "normal");
  later.observe(true);
  CHECK(later.word() == "acknowledged");  // somebody knows of it
  later.observe(false);
  later.observe(true);
  CHECK(later.word() == "unacknowledged");  // that was another one
}

TEST_CASE("where its cause is known over a restart an alarm goes on as it was") {
  Bench before;
  before.observe(true);
  Bench after;
  after.alarm.resume(before.alarm.standing());
  CHECK(after.word() == "unacknowledged");
  after.observe(true);
  CHECK(after.occurred() == List{});
  CHECK(after.apply(AlarmAction::kAcknowledge).accepted);

  Bench later;
  later.alarm.resume(after.alarm.standing());
  CHECK(later.word() == "acknowledged");
  later.observe(false);  // it went while nobody was there to tell
  CHECK(later.occurred() == List{kCleared});
  CHECK(later.word() == "normal");

  Bench last;
  last.alarm.resume(later.alarm.standing());
  last.observe(true);
  CHECK(last.occurred() == List{kActive});
  CHECK(last.word() == "unacknowledged");
}

}  // namespace
}  // namespace mpm::managed_alarm_test
