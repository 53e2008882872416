#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "tests/system/bench.hpp"

namespace mpm::test::standby_test {
namespace {

using namespace std::chrono_literals;
constexpr const char* kToken = "0123456789abcdef0123456789abcdef";
constexpr int kFrames = 3000;  // until the alarm of a gain of 3 instead of 2, and more

/// Monitors of one unit that stand by for one another, its plant, and one who reads.
struct Cell {
  explicit Cell(const std::string& test) : options(idl::test_domain(test)), participant(options) {
    write_file(folder.file("toy.yaml"), unit_yaml("toy"));
    write_file(folder.file("token"), std::string(kToken) + "\n");
    std::filesystem::permissions(folder.file("token"), std::filesystem::perms::owner_read);
    UnitLayout layout;
    layout.unit = "toy";
    layout[SignalKind::kMv].tags = {"u1", "u2"};
    layout[SignalKind::kCv].tags = {"y1"};
    publisher.emplace(participant, layout, idl::WriterPace::kRealTime);
    readers.emplace(participant);
  }

  /// A monitor that was not there before, or was and comes back.
  void start(const std::string& name, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"mpmd",
                                          "--config",
                                          folder.file("toy.yaml"),
                                          "--domain",
                                          std::to_string(options.domain),
                                          "--partition",
                                          options.partition,
                                          "--state-dir",
                                          folder.file(name),
                                          "--token-file",
                                          folder.file("token"),
                                          "--standby"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    monitors.emplace(name,
                     Process(arguments, folder.file(name + ".out"), folder.file(name + ".err")));
    REQUIRE(idl::eventually(
        [&] { return log(name).find("watching 2 channels") != std::string::npos; }, 20s));
    // Found by the plant, and by the others.
    REQUIRE(publisher->wait_for_readers(20s, static_cast<int>(monitors.size())));
    std::this_thread::sleep_for(2500ms);
  }
  [[nodiscard]] std::string log(const std::string& name) const {
    return read_file(folder.file(name + ".err"));
  }
  /// Until `name` is the one that speaks.
  void await(const std::string& name) {
    REQUIRE(idl::eventually(
        [&] {
          look();
          const std::string text = log(name);
          const std::size_t speaks = text.rfind("toy: speaks");
          return speaks != std::string::npos && text.find("toy: stands by", speaks) == text.npos;
        },
        20s));
  }
  void kill(const std::string& name) {
    Process& process = monitors.at(name);
    process.send(SIGKILL);
    REQUIRE(process.wait(10s));
    monitors.erase(name);
  }
  /// A frame each millisecond, which a control system would take a second for.
  void play(Plant& plant, int frames) {
    for (int i = 0; i < frames; ++i) {
      const Frame& frame = plant.next();
      played = frame.interval;
      REQUIRE(publisher->publish(frame));
      std::this_thread::sleep_for(1ms);
      look();
    }
  }
  void look() {
    for (const idl::Output& output : readers->take()) {
      if (const auto* event = std::get_if<AlarmRecord>(&output); event) events.push_back(*event);
      if (const auto* state = std::get_if<AlarmStateRecord>(&output)) states[state->mv] = *state;
      if (const auto* channel = std::get_if<ChannelRecord>(&output)) last = channel->interval;
    }
  }
  /// Until something has been said of the last frames that were played; false where nobody does.
  [[nodiscard]] bool said() {
    return idl::eventually(
        [&] {
          look();
          return last >= played;
        },
        20s);
  }
  [[nodiscard]] std::vector<AlarmChange> changes(const std::string& mv) const {
    std::vector<AlarmChange> found;
    for (const AlarmRecord& event : events)
      if (event.mv == mv && event.to != AlarmChange::kDiagnosed) found.push_back(event.to);
    return found;
  }
  /// What one sees who comes now.
  [[nodiscard]] AlarmStateRecord seen_by_newcomer(const std::string& mv) {
    idl::OutputReaders newcomer(participant);
    AlarmStateRecord state;
    (void)idl::eventually(
        [&] {
          for (const idl::Output& output : newcomer.take())
            if (const auto* alarm = std::get_if<AlarmStateRecord>(&output);
                alarm && alarm->mv == mv)
              state = *alarm;
          return false;
        },
        1s);
    return state;
  }

  TemporaryFolder folder;
  idl::DomainOptions options;
  idl::Participant participant;
  std::optional<idl::UnitPublisher> publisher;
  std::optional<idl::OutputReaders> readers;
  std::map<std::string, Process> monitors;
  std::vector<AlarmRecord> events;
  std::map<std::string, AlarmStateRecord> states;
  std::int64_t last = 0, played = 0;
};

const std::vector<AlarmChange> kRose = {AlarmChange::kActive};

}  // namespace

// The expected events are those of one monitor that nobody kills: u1's alarm rises, once.
TEST_CASE("a monitor stands by: kill the one that speaks, and no alarm is lost or doubled") {
  Cell cell("standby-kills");
  cell.start("a");
  cell.await("a");
  cell.start("b");
  Plant plant(3.0);
  std::mt19937 random(5);
  std::string speaks = "a", waits = "b";
  for (int kills = 0; kills < 4; ++kills) {
    cell.play(plant, 500 + static_cast<int>(random() % 500));
    cell.kill(speaks);
    cell.play(plant, 400);  // the control system goes on
    cell.await(waits);
    CHECK(cell.said());
    cell.start(speaks);  // comes back, and does not claim what it had
    std::swap(speaks, waits);
  }
  CAPTURE(cell.log("a"), cell.log("b"));
  CHECK(cell.changes("u1") == kRose);
  CHECK(cell.changes("u2").empty());
  CHECK(cell.states["u1"].to == AlarmChange::kActive);
  CHECK(cell.seen_by_newcomer("u1").to == AlarmChange::kActive);
  CHECK(cell.seen_by_newcomer("u2").mv == "u2");
}

TEST_CASE("who speaks can be read on the bus") {
  Cell cell("standby-role");
  cell.start("a");
  cell.await("a");
  const auto mpm = [&cell](const std::vector<std::string>& words) {
    std::vector<std::string> all{"mpm"};
    all.insert(all.end(), words.begin(), words.end());
    all.insert(all.end(), {"--domain", std::to_string(cell.options.domain), "--partition",
                           cell.options.partition});
    REQUIRE(run(all, cell.folder.file("out"), cell.folder.file("err")) == 0);
    return read_file(cell.folder.file("out"));
  };
  const std::string line = mpm({"echo", "mpm/role", "--once", "--json", "--duration", "10"});
  CHECK_THAT(line, Catch::Matchers::Contains(R"({"topic":"mpm/role",)") &&
                       Catch::Matchers::Contains(R"("sample":{"unit":"toy","host":")") &&
                       Catch::Matchers::Contains(R"("active":true)"));
  CHECK_THAT(
      mpm({"topics", "--json"}),
      Catch::Matchers::Contains(
          R"("topic":"mpm/role","type":"mpm::Role","writers":1,"readers":1,"units":["toy"])"));
}

TEST_CASE("one that knows nothing yet lets stand what stood, as people left it") {
  Cell cell("standby-cold");
  cell.start("a");
  cell.await("a");
  Plant wrong(3.0);
  cell.play(wrong, kFrames);
  REQUIRE(idl::eventually([&] {
    cell.look();
    return cell.changes("u1") == kRose;
  }));
  REQUIRE(run({"mpm", "ack", "--domain", std::to_string(cell.options.domain), "--partition",
               cell.options.partition, "--unit", "toy", "--mv", "u1", "--cv", "y1", "--user", "ann",
               "--comment", "seen", "--token-file", cell.folder.file("token")},
              cell.folder.file("out"), cell.folder.file("err")) == 0);
  cell.start("b");
  cell.play(wrong, 20);  // far too few to judge by
  cell.kill("a");
  cell.play(wrong, 300);
  cell.await("b");
  CHECK(cell.said());
  CHECK(cell.changes("u1") == kRose);
  CHECK(cell.states["u1"].to == AlarmChange::kActive);
  CHECK(cell.states["u1"].view.client_user_id == "ann");
  CHECK(cell.states["u1"].view.acknowledged);
  CHECK(cell.seen_by_newcomer("u1").to == AlarmChange::kActive);
  // Its own journal knows who did what where it stood by.
  REQUIRE(run({"mpm", "journal", "--journal", cell.folder.file("b") + "/alarms.sqlite"},
              cell.folder.file("out"), cell.folder.file("err")) == 0);
  CAPTURE(read_file(cell.folder.file("out")));
  CHECK_THAT(read_file(cell.folder.file("out")), Catch::Matchers::Contains("acknowledged") &&
                                                     Catch::Matchers::Contains("ann") &&
                                                     Catch::Matchers::Contains("seen"));

  SECTION("its own judgement then says the same, and nobody is told twice") {
    cell.play(wrong, kFrames);
    CHECK(cell.changes("u1") == kRose);
    CHECK(cell.states["u1"].to == AlarmChange::kActive);
    CHECK(cell.states["u1"].view.acknowledged);
  }
  SECTION("or that it is over, which is told once") {
    cell.start("c");  // has not seen what was wrong
    cell.kill("b");
    Plant mended(2.0);
    for (int i = 0; i < kFrames + 330; ++i) (void)mended.next();  // the numbers go on
    cell.play(mended, kFrames);
    cell.await("c");
    CHECK(cell.said());
    CAPTURE(cell.log("c"));
    CHECK(cell.changes("u1") == std::vector{AlarmChange::kActive, AlarmChange::kCleared});
    CHECK(cell.states["u1"].to == AlarmChange::kCleared);
  }
}

TEST_CASE("a monitor that hangs is as good as dead, and one of two speaks when it goes on") {
  Cell cell("standby-hangs");
  cell.start("a", {"--standby-rank", "7"});
  cell.await("a");
  cell.start("b");
  Plant plant(3.0);
  cell.play(plant, kFrames / 2);
  cell.monitors.at("a").send(SIGSTOP);
  cell.play(plant, kFrames / 2);
  cell.await("b");
  CHECK(cell.said());
  cell.monitors.at("a").send(SIGCONT);
  cell.play(plant, kFrames / 2);
  CHECK(cell.said());
  CHECK(cell.changes("u1") == kRose);
  CHECK(cell.changes("u2").empty());
  cell.await("a");  // of two that speak the one of the greater rank goes on
}

TEST_CASE("of two that start together the one of greater rank speaks, and says when it is alone") {
  Cell cell("standby-rank");
  cell.start("b");
  cell.await("b");
  cell.start("a", {"--standby-rank", "7"});  // whoever speaks goes on
  Plant plant(2.0);
  cell.play(plant, 200);
  CHECK(cell.log("a").find("toy: speaks") == std::string::npos);
  REQUIRE(cell.monitors.at("b").pid() > 0);
  cell.monitors.at("b").send(SIGTERM);
  REQUIRE(cell.monitors.at("b").wait(20s) == 0);
  cell.await("a");
  REQUIRE(idl::eventually(
      [&] {
        return cell.log("a").find("no other monitor stands by for this unit") != std::string::npos;
      },
      40s));
}

}  // namespace mpm::test::standby_test
