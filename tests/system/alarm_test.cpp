#include <catch2/catch.hpp>
#include <csignal>

#include "tests/allocation_counter.hpp"
#include "tests/system/bench.hpp"

namespace mpm::test {
namespace {

constexpr int kEnough = 4000;  // frames until a doubled gain has long been noticed

}  // namespace

TEST_CASE("a mismatch becomes an alarm that who joins later sees; SIGTERM ends the daemon") {
  Bench bench("alarm");
  const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kLossless);
  Plant plant(4.0);
  bench.publish(publisher, plant, kEnough);
  REQUIRE(bench.observe([&] { return bench.health().frames == kEnough; }));
  CHECK(bench.health().active_alarms > 0);
  CHECK(bench.health().state == "maintenance_required");

  SECTION("as a reader of mpm/alarm") {
    const idl::Participant late(bench.options);
    idl::OutputReaders readers(late);
    std::vector<AlarmStateRecord> states;
    std::vector<AlarmRecord> events;
    CHECK(idl::eventually([&] {
      for (const idl::Output& output : readers.take()) {
        if (const auto* state = std::get_if<AlarmStateRecord>(&output)) states.push_back(*state);
        if (const auto* event = std::get_if<AlarmRecord>(&output)) events.push_back(*event);
      }
      return states.size() == 2 && !events.empty();
    }));
    REQUIRE(states.size() == 2);  // one per channel
    const AlarmRecord& first = states[0].mv == "u1" ? states[0] : states[1];
    CHECK(first.cv == "y1");
    CHECK(first.to == AlarmChange::kActive);
    CHECK(first.source_time_ns > 0);
    CHECK(first.effect_size == Approx(2.0).margin(0.5));  // gain 4 instead of 2
  }
  SECTION("with mpm watch --until-alarm") {
    CHECK(run(bench.watch({"--until-alarm", "--for", "20"}), bench.folder.file("watch.out"),
              bench.folder.file("watch.err")) == 0);
    const std::string shown = read_file(bench.folder.file("watch.out"));
    INFO(shown);
    CHECK(shown.find("u1 -> y1: alarm active") != std::string::npos);
    CHECK(shown.find('\x1b') == std::string::npos);  // not a terminal
  }

  bench.daemon.send(SIGTERM);
  CHECK(bench.daemon.wait(std::chrono::seconds(1)) == 0);
  CHECK(bench.observe([&] { return !bench.seen<idl::MonitorGone>().empty(); }));
  INFO(read_file(bench.folder.file("mpmd.err")));
  CHECK(read_file(bench.folder.file("mpmd.err")).find(" warning toy: u1 -> y1: alarm active") !=
        std::string::npos);
}

TEST_CASE("a right model raises no alarm, and the channels become matches") {
  Bench bench("quiet");
  const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kLossless);
  Plant plant(2.0);
  bench.publish(publisher, plant, kEnough);
  REQUIRE(bench.observe([&] { return bench.health().frames == kEnough; }));
  CHECK(bench.seen<AlarmRecord>().empty());
  CHECK(bench.health().matching == 2);
  CHECK(bench.health().state == "normal");
  for (const auto& state : bench.seen<AlarmStateRecord>()) CHECK(state.to == AlarmChange::kCleared);
}

TEST_CASE("mpm watch --json prints what the journal holds, byte for byte, at full speed") {
  TemporaryFolder folder;
  Bench bench("journal", {"--journal-every-sample", folder.file("journal.jsonl")});
  Process watch(bench.watch({"--json"}), folder.file("watch.out"), folder.file("watch.err"));
  REQUIRE(idl::eventually(
      [&] { return read_file(folder.file("watch.out")).find("health") != std::string::npos; }));
  const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kLossless);
  Plant plant(4.0);
  bench.publish(publisher, plant, kEnough);
  REQUIRE(bench.observe([&] { return bench.health().frames == kEnough; }));

  const auto records = [](const std::string& path, const std::string& kind) {
    std::vector<std::string> lines;
    for (const std::string& line : lines_of(read_file(path)))
      if (line.find("\"record\":\"" + kind + "\"") != std::string::npos) lines.push_back(line);
    return lines;
  };
  const auto written = records(folder.file("journal.jsonl"), "channel");
  REQUIRE(written.size() == 2 * kEnough);
  CHECK(idl::eventually(
      [&] { return records(folder.file("watch.out"), "channel").size() >= written.size(); }));
  CHECK(records(folder.file("watch.out"), "channel") == written);
  CHECK(records(folder.file("watch.out"), "alarm") ==
        records(folder.file("journal.jsonl"), "alarm"));
  bench.daemon.send(SIGTERM);
  CHECK(idl::eventually([&] {
    return read_file(folder.file("watch.out"))
               .find("\n{\"record\":\"monitor_gone\",\"unit\":\"toy\"}\n") != std::string::npos;
  }));
  watch.send(SIGINT);
  CHECK(watch.wait(std::chrono::seconds(2)) == 0);
}

TEST_CASE("a frozen viewer holds nothing up") {
  Bench bench("frozen");
  Process watch(bench.watch({"--json"}), bench.folder.file("watch.out"),
                bench.folder.file("watch.err"));
  REQUIRE(idl::eventually([&] {
    return read_file(bench.folder.file("watch.out")).find("health") != std::string::npos;
  }));
  watch.send(SIGSTOP);
  const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kLossless);
  Plant plant(2.0);
  const int frames = resident_memory_is_ours() ? 20'000 : 2'000;  // a sanitizer is slow
  bench.publish(publisher, plant, frames);
  REQUIRE(bench.observe([&] { return bench.health().frames == static_cast<unsigned>(frames); }));
  WARN("beside a frozen viewer the daemon has " << bench.daemon.resident_kb() << " kB");
  if (resident_memory_is_ours()) CHECK(bench.daemon.resident_kb() < 60'000);
  watch.send(SIGCONT);
}

}  // namespace mpm::test
