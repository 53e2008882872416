#include "daemon/live/unit_alarms.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "daemon/live/alarm_journal.hpp"
#include "idl/output_readers.hpp"
#include "idl/output_writers.hpp"
#include "tests/daemon/report/sample_channels.hpp"
#include "tests/idl/test_domain.hpp"
#include "tests/system/process.hpp"

namespace mpm::live::unit_alarms_test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr const char* kMv = "FIC-101";
constexpr const char* kCv = "AI-201";

/// The alarms of one channel in a process that shares its unit with others, and one who reads.
struct Desk {
  explicit Desk(const std::string& test)
      : participant(idl::test_domain(test)), writers(participant), readers(participant) {}

  /// A sample; the alarm is `active`, and may have changed.
  void sample(bool active, bool changed) {
    ++interval;
    channels[0] = active ? report::mismatch(kMv, kCv) : report::match(kMv, kCv);
    channels[0].unit = unit.unit;
    channels[0].alarm = active ? AlarmState::kActive : AlarmState::kCleared;
    channels[0].interval = interval;
    channels[0].source_time_ns = interval * kSecond;
    std::vector<AlarmRecord> changes;
    if (changed) changes.push_back(change(active ? AlarmChange::kActive : AlarmChange::kCleared));
    REQUIRE(alarms.push(channels, changes, {changes.size(), "gain not known"}, 0));
  }
  [[nodiscard]] AlarmRecord change(AlarmChange to) const {
    AlarmRecord record = report::alarm(channels[0], to, interval * kSecond);
    record.unit = unit.unit;
    record.interval = interval;
    return record;
  }
  /// Of the alarm that rose with `rise`.
  void diagnose(AlarmRecord rise, const std::string& text) {
    rise.to = AlarmChange::kDiagnosed;
    rise.named.cause = "gain";
    rise.named.text = text;
    REQUIRE(alarms.diagnosed(rise, interval, interval * kSecond, 0));
  }
  [[nodiscard]] const AlarmStateRecord& state() const { return alarms.channels()[0]; }
  /// The diagnoses that were told up to one last word.
  [[nodiscard]] std::vector<std::string> told() {
    std::vector<std::string> texts;
    HealthRecord last;
    last.unit = unit.unit;
    last.detail = "last";
    REQUIRE(idl::eventually([&] {
      REQUIRE(writers.write(last));
      bool ended = false;
      for (const idl::Output& output : readers.take()) {
        if (const auto* event = std::get_if<AlarmRecord>(&output);
            event != nullptr && event->to == AlarmChange::kDiagnosed)
          texts.push_back(event->named.text);
        ended = ended || std::holds_alternative<HealthRecord>(output);
      }
      return ended;
    }));
    return texts;
  }

  config::UnitConfig unit = report::column();
  std::vector<ChannelRecord> channels{report::match(kMv, kCv)};
  std::int64_t interval = 0;
  idl::Participant participant;
  idl::OutputWriters writers;
  idl::OutputReaders readers;
  UnitOutputs outputs{writers};
  UnitAlarms alarms{unit, outputs, channels};
};

/// What the other monitor has said of the alarm that rose here with `rise`.
ToldAlarms told_of(const AlarmRecord& rise) {
  ToldAlarms told;
  AlarmStateRecord state{rise};
  AlarmStanding standing;
  standing.annunciation = Annunciation::kAcknowledged;
  state.view = ControlRoomView(standing, NotificationClass::kAlert, AlarmPriority::kLow);
  state.view.message = "gain not known";
  told.states[{rise.mv, rise.cv}] = state;
  told.events[{rise.mv, rise.cv}] = rise;
  return told;
}

}  // namespace

TEST_CASE("who takes over tells the cause that it alone has found, once") {
  Desk desk("alarms-cause");
  desk.outputs.be_silent(true);
  desk.sample(true, true);
  const AlarmRecord rise = desk.change(AlarmChange::kActive);
  desk.sample(true, false);
  desk.diagnose(rise, "gain 80 % more");
  desk.outputs.be_silent(false);
  ToldAlarms told = told_of(rise);

  SECTION("where the other one has told none") {
    REQUIRE(desk.alarms.take_over(told, desk.channels, 0));
    CHECK(desk.state().view.message == "gain 80 % more");
    CHECK(desk.state().view.acknowledged);
    CHECK(desk.told() == std::vector<std::string>{"gain 80 % more"});
  }
  SECTION("not where the other one has told it, or a younger one") {
    AlarmRecord& event = told.events.at({kMv, kCv});
    event.to = AlarmChange::kDiagnosed;
    event.source_time_ns = desk.interval * kSecond;
    event.named.text = told.states.at({kMv, kCv}).view.message = "gain 79 % more";
    told.states.at({kMv, kCv}).named = event.named;
    REQUIRE(desk.alarms.take_over(told, desk.channels, 0));
    CHECK(desk.state().view.message == "gain 79 % more");
    CHECK(desk.told().empty());
  }
  SECTION("nor of an alarm that was another one") {
    told.states.at({kMv, kCv}).source_time_ns = (desk.interval + 1) * kSecond;
    REQUIRE(desk.alarms.take_over(told, desk.channels, 0));
    CHECK(desk.state().view.message == "gain not known");
    CHECK(desk.told().empty());
  }
}

TEST_CASE("after a restart the controller's alarm counts the channels that stand as before") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("alarms.sqlite");
  std::string message;
  {
    AlarmJournal journal(path);
    Desk desk("alarms-restart");
    desk.alarms.keep(journal, 0);
    desk.sample(true, true);
    CHECK(desk.alarms.controller().channels == 1);
    message = desk.alarms.controller().view.message;
    // What is said last of the channel is younger than what is said of the controller's alarm.
    AlarmCommand seen;
    seen.unit = desk.unit.unit;
    seen.mv = kMv;
    seen.cv = kCv;
    seen.user = "operator";
    REQUIRE(desk.alarms.apply(seen, 0).accepted);
  }
  AlarmJournal journal(path);
  Desk desk("alarms-restart");
  desk.channels[0] = report::mismatch(kMv, kCv);
  desk.channels[0].alarm = AlarmState::kActive;
  desk.alarms.recall(desk.channels, {desk.change(AlarmChange::kActive)}, {"gain not known"});
  desk.alarms.keep(journal, 0);
  CHECK(desk.alarms.controller().channels == 1);
  CHECK(desk.alarms.controller().view.message == message);
}

TEST_CASE("the controller's alarm is not over while all that stands is silenced") {
  Desk desk("alarms-silenced");
  desk.sample(true, true);
  const std::string message = desk.alarms.controller().view.message;
  AlarmCommand shelve;
  shelve.unit = desk.unit.unit;
  shelve.mv = kMv;
  shelve.cv = kCv;
  shelve.user = "operator";
  shelve.action = AlarmAction::kShelve;
  shelve.duration_s = 60.0;
  CHECK(desk.alarms.silenced_channels() == 0);
  REQUIRE(desk.alarms.apply(shelve, 0).accepted);
  CHECK(desk.alarms.silenced_channels() == 1);
  CHECK(desk.alarms.controller().state == AlarmState::kCleared);
  CHECK(desk.alarms.controller().view.message == "silenced: " + message);
  SECTION("it comes back when the silence ends") {
    shelve.action = AlarmAction::kUnshelve;
    REQUIRE(desk.alarms.apply(shelve, 0).accepted);
    desk.sample(true, false);
    CHECK(desk.alarms.controller().view.message == message);
  }
  SECTION("it is over once what was silenced has cleared") {
    desk.sample(false, true);
    CHECK(desk.alarms.silenced_channels() == 0);
    CHECK(desk.alarms.controller().view.message == "over: " + message);
  }
}

TEST_CASE("an alarm that was raised before its size was known says it once it is") {
  Desk desk("alarms-size");
  desk.sample(true, true);
  CHECK(desk.state().view.message == "gain not known");
  REQUIRE(desk.alarms.size_known(0, "gain +53 %"));
  CHECK(desk.state().view.message == "gain +53 %");
  desk.sample(true, false);
  CHECK(desk.state().view.message == "gain +53 %");
  desk.sample(false, true);
  CHECK(desk.state().view.message == "over: gain +53 %");
}

TEST_CASE("the text of an alarm that has cleared says so") {
  Desk desk("alarms-over");
  desk.sample(true, true);
  CHECK(desk.state().view.message == "gain not known");
  desk.sample(false, true);
  CHECK(desk.state().view.message == "over: gain not known");
  desk.sample(false, false);
  CHECK(desk.state().view.message == "over: gain not known");
  desk.sample(true, true);
  CHECK(desk.state().view.message == "gain not known");
}

}  // namespace mpm::live::unit_alarms_test
