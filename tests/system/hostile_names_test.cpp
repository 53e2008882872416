#include <catch2/catch.hpp>
#include <csignal>
#include <thread>

#include "tests/allocation_counter.hpp"
#include "tests/system/bench.hpp"

namespace mpm::test {
namespace {

constexpr std::size_t kMegabyte = 1'000'000;

/// A unit of one MV and one CV that nobody watches.
idl::UnitPublisher stranger(const Bench& bench, const std::string& name) {
  UnitLayout layout;
  layout.unit = name;
  layout[SignalKind::kMv].tags = {name};
  layout[SignalKind::kCv].tags = {name};
  return {bench.participant, layout, idl::WriterPace::kRealTime};
}

}  // namespace

TEST_CASE("a name on the bus neither forges a line of the log nor fills the memory") {
  Bench bench("hostile_names");
  const Frame frame(SignalCounts{1, 0, 1, 0});
  const long before_kb = bench.daemon.resident_kb();
  const auto unknown = [&] { return bench.health().unknown_unit; };

  const idl::UnitPublisher forger = stranger(bench, "x\n<3>toy: u1 -> y1: alarm active\x1b[2J\xff");
  REQUIRE(forger.wait_for_readers(std::chrono::seconds(20)));
  static_cast<void>(forger.publish(frame));
  REQUIRE(bench.observe([&] { return unknown() >= 2; }));

  for (int i = 0; i < 10; ++i) {
    const idl::UnitPublisher flood =
        stranger(bench, std::to_string(i) + std::string(10 * kMegabyte, 'n'));
    static_cast<void>(flood.publish(frame));
  }
  const idl::UnitPublisher known = bench.publisher(idl::WriterPace::kLossless);
  Plant plant(2.0);
  bench.publish(known, plant, 50);
  CHECK(bench.observe([&] { return bench.health().frames >= 40; }));
  if (resident_memory_is_ours()) CHECK(bench.daemon.resident_kb() < before_kb + 50'000);

  bench.daemon.send(SIGTERM);
  CHECK(bench.daemon.wait(std::chrono::seconds(10)) == 0);
  bool told = false;
  for (const std::string& line : lines_of(read_file(bench.folder.file("mpmd.err")))) {
    CAPTURE(line.substr(0, 200));
    CHECK(line.size() < 2000);
    CHECK(line.rfind("<3>toy", 0) != 0);
    CHECK(line.find('\x1b') == std::string::npos);
    told =
        told || line.find("'x\\n<3>toy: u1 -> y1: alarm active\\x1b[2J\\xff'") != std::string::npos;
  }
  CHECK(told);
}

TEST_CASE("a unit that nobody watches is named once, however often its samples come") {
  Bench bench("hostile_often");
  const Frame frame(SignalCounts{1, 0, 1, 0});
  const idl::UnitPublisher often = stranger(bench, "often"), other = stranger(bench, "other");
  REQUIRE(often.wait_for_readers(std::chrono::seconds(20)));
  REQUIRE(other.wait_for_readers(std::chrono::seconds(20)));
  for (int i = 0; i < 20; ++i) {
    static_cast<void>(often.publish(frame));
    if (i == 15) static_cast<void>(other.publish(frame));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  REQUIRE(bench.observe([&] { return bench.health().unknown_unit >= 42; }));
  std::vector<std::string> told;
  for (const std::string& line : lines_of(read_file(bench.folder.file("mpmd.err"))))
    if (line.find("samples of unit '") != std::string::npos) told.push_back(line);
  REQUIRE(told.size() == 2);
  CHECK(told[0].find("'often', which no unit file describes; ignored") != std::string::npos);
  CHECK(told[1].find("'other'") != std::string::npos);
}

TEST_CASE("long names of units that stay on the bus do not fill the memory") {
  Bench bench("hostile_stay");
  const Frame frame(SignalCounts{1, 0, 1, 0});
  const long before_kb = bench.daemon.resident_kb();
  std::vector<idl::UnitPublisher> strangers;
  for (int i = 0; i < 60; ++i) {
    strangers.push_back(stranger(bench, std::to_string(i) + std::string(9 * kMegabyte / 10, 'n')));
    static_cast<void>(strangers.back().publish(frame));
  }
  const idl::UnitPublisher known = bench.publisher(idl::WriterPace::kLossless);
  Plant plant(2.0);
  bench.publish(known, plant, 50);
  CHECK(bench.observe([&] { return bench.health().frames >= 40; }));
  if (resident_memory_is_ours()) CHECK(bench.daemon.resident_kb() < before_kb + 50'000);
}

TEST_CASE("what strangers write does not fill the memory of a recorder, and that is said") {
  Bench bench("hostile_recorded");
  const Frame frame(SignalCounts{1, 0, 1, 0});
  const std::string recording = bench.folder.file("run.mcap");
  Process recorder(
      {"mpm", "record", "--output", recording, "--max-size", "10MB", "--quota", "40MB", "--domain",
       std::to_string(bench.options.domain), "--partition", bench.options.partition},
      bench.folder.file("record.out"), bench.folder.file("record.err"));
  const idl::UnitPublisher known = bench.publisher(idl::WriterPace::kLossless);
  REQUIRE(known.wait_for_readers(std::chrono::seconds(20), 2));
  Plant plant(2.0);
  bench.publish(known, plant, 50);
  const long before_kb = recorder.resident_kb();
  std::vector<idl::UnitPublisher> strangers;
  for (int i = 0; i < 60; ++i) {  // names that no unit file gives, and layouts that none needs
    strangers.push_back(stranger(bench, std::to_string(i) + std::string(9 * kMegabyte / 10, 'n')));
    // The first one is named: its sample has to come, however busy the machine.
    if (i == 0) REQUIRE(strangers.back().wait_for_readers(std::chrono::seconds(20)));
    static_cast<void>(strangers.back().publish(frame));
    UnitLayout layout;
    layout.unit = "stranger" + std::to_string(i);
    layout[SignalKind::kMv].tags = {std::string(2 * kMegabyte, 't')};
    layout[SignalKind::kCv].tags = {"y"};
    strangers.emplace_back(bench.participant, layout, idl::WriterPace::kRealTime);
  }
  bench.publish(known, plant, 50);
  REQUIRE(known.flush(std::chrono::seconds(20)));
  const auto is_back = [&] { return recorder.resident_kb() < before_kb + 60'000; };
  for (int i = 0; i < 50 && !is_back(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  if (resident_memory_is_ours()) CHECK(is_back());
  recorder.send(SIGTERM);
  CHECK(recorder.wait(std::chrono::seconds(20)) == 0);
  const std::string said = read_file(bench.folder.file("record.err"));
  INFO(said.substr(0, 5000));
  CHECK(said.find("not recorded: samples of mpm/mv such as those of '0nnn") != std::string::npos);
  CHECK(said.find("is in one file only") != std::string::npos);
  CHECK(said.size() < 5000);
}

}  // namespace mpm::test
