#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>

#include "tests/idl/test_domain.hpp"
#include "tests/system/process.hpp"

namespace mpm::test::clock_step_test {
namespace {

const std::string kUnit = MPM_SOURCE_DIR "/config/plants/shell3x3.yaml";
const std::string kPreload = std::string("LD_PRELOAD=") + MPM_STEP_CLOCK;
constexpr int kSamples = 600;

/// A sanitizer wants to be loaded first; what else it was told stays.
std::string asan_options() {
  const char* told = std::getenv("ASAN_OPTIONS");
  return std::string("ASAN_OPTIONS=") + (told == nullptr ? "" : told) + ":verify_asan_link_order=0";
}

/// What the recorder's machine does to its clock meanwhile.
struct ClockTrouble {
  const char* name;
  const char* step_ms;
  const char* every;  // readings of the clock
};

void check_recording_under(const ClockTrouble& trouble) {
  CAPTURE(trouble.name);
  TemporaryFolder folder;
  const idl::DomainOptions domain = idl::test_domain(std::string("clock_step") + trouble.name);
  const auto must = [&](const std::vector<std::string>& command) {
    CAPTURE(command);
    const auto code = run(command, folder.file("out"), folder.file("err"));
    INFO(read_file(folder.file("err")));
    REQUIRE(code == 0);
  };
  const std::vector<std::string> simulate = {"mpmsim",
                                             "--config",
                                             kUnit,
                                             "--scenario",
                                             "hidden_gain",
                                             "--seed",
                                             "5",
                                             "--samples",
                                             std::to_string(kSamples),
                                             "--start-time",
                                             "0"};
  std::vector<std::string> to_file = simulate;
  to_file.insert(to_file.end(), {"--csv", folder.file("run.csv")});
  must(to_file);
  must({"mpm", "detect", "--config", kUnit, "--data", folder.file("run.csv"),
        "--journal-every-sample", folder.file("expected.jsonl")});
  const std::string expected = read_file(folder.file("expected.jsonl"));
  const auto wait_for_journal = [&](const std::string& name) {
    CHECK(idl::eventually([&] { return read_file(folder.file(name)).size() >= expected.size(); },
                          std::chrono::seconds(20)));
    const bool identical = read_file(folder.file(name)) == expected;
    CHECK(identical);  // byte for byte; not printed: megabytes
  };
  const auto monitor = [&](const std::string& journal) {
    return Process({"mpmd", "--config", kUnit, "--partition", domain.partition,
                    "--journal-every-sample", folder.file(journal)},
                   folder.file("mpmd.out"), folder.file("mpmd.err"));
  };
  {
    Process daemon = monitor("live.jsonl");
    Process recorder({"mpm", "record", "--unit", "shell", "--partition", domain.partition,
                      "--output", folder.file("run.mcap")},
                     folder.file("record.out"), folder.file("record.err"),
                     {kPreload, asan_options(), std::string("MPM_STEP_MS=") + trouble.step_ms,
                      std::string("MPM_STEP_EVERY=") + trouble.every});
    std::vector<std::string> to_bus = simulate;
    to_bus.insert(to_bus.end(), {"--speed", "500", "--wait-readers", "20", "--readers", "2",
                                 "--partition", domain.partition});
    must(to_bus);
    wait_for_journal("live.jsonl");
    recorder.send(SIGINT);
    CHECK(recorder.wait(std::chrono::seconds(10)) == 0);
    daemon.send(SIGTERM);
    CHECK(daemon.wait(std::chrono::seconds(5)) == 0);
  }

  must({"mpm", "detect", "--config", kUnit, "--data", folder.file("run.mcap"),
        "--journal-every-sample", folder.file("detect.jsonl")});
  const bool detected = read_file(folder.file("detect.jsonl")) == expected;
  CHECK(detected);
  must({"mpm", "convert", folder.file("run.mcap"), folder.file("back.csv")});
  CHECK(lines_of(read_file(folder.file("back.csv"))).size() == 1 + kSamples);
  Process fresh = monitor("replay.jsonl");
  must({"mpm", "replay", folder.file("run.mcap"), "--rate", "0", "--partition", domain.partition});
  wait_for_journal("replay.jsonl");
  fresh.send(SIGTERM);
  CHECK(fresh.wait(std::chrono::seconds(5)) == 0);
}

TEST_CASE("a recording keeps the order of arrival while somebody sets the clock") {
  for (const ClockTrouble& trouble :
       {ClockTrouble{"back", "-2000", "40"}, ClockTrouble{"forward", "2000", "40"},
        ClockTrouble{"hour_back", "-3600000", "60"}, ClockTrouble{"hour_forward", "3600000", "60"},
        ClockTrouble{"jitter", "30", "1"}})
    check_recording_under(trouble);
}

// On a quiet bus, where nothing else would wake it.
TEST_CASE("a monitor goes on while the clock is set back by an hour") {
  TemporaryFolder folder;
  const idl::DomainOptions domain = idl::test_domain("clock_back");
  Process daemon(
      {"mpmd", "--config", kUnit, "--partition", domain.partition}, folder.file("mpmd.out"),
      folder.file("mpmd.err"),
      {kPreload, asan_options(), "MPM_STEP_MS=3600000", "MPM_STEP_EVERY=0", "MPM_STEP_WAITS=1"});
  const auto said = [&](const char* word) {
    return read_file(folder.file("mpmd.err")).find(word) != std::string::npos;
  };
  REQUIRE(idl::eventually([&] { return said("watching"); }, std::chrono::seconds(20)));
  daemon.send(SIGTERM);
  CHECK(idl::eventually([&] { return said("stopped"); }, std::chrono::seconds(10)));
}

}  // namespace
}  // namespace mpm::test::clock_step_test
