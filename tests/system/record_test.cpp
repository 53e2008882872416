#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <random>
#include <regex>
#include <thread>

#include "daemon/mcap/read/ordered_reader.hpp"
#include "daemon/mcap/recover.hpp"
#include "idl/raw_sample.hpp"
#include "tests/system/bench.hpp"

namespace mpm::test::record_test {
namespace {

using Clock = std::chrono::steady_clock;

const std::string kUnit = MPM_SOURCE_DIR "/config/plants/shell3x3.yaml";
constexpr std::chrono::seconds kPatience{20};

// More by hand: `./run rehearse`.
int runs(int by_default) {
  const char* text = std::getenv("MPM_RUNS");
  return text == nullptr ? by_default : std::max(1, std::atoi(text));
}

/// One run on a corner of the network of its own.
struct Stage {
  explicit Stage(const std::string& test) : domain(idl::test_domain(test)) {}

  [[nodiscard]] std::vector<std::string> on_bus(std::vector<std::string> arguments) const {
    const std::vector<std::string> where = {"--domain", std::to_string(domain.domain),
                                            "--partition", domain.partition};
    arguments.insert(arguments.end(), where.begin(), where.end());
    return arguments;
  }
  [[nodiscard]] Process start(const std::string& name, const std::vector<std::string>& arguments) {
    return {on_bus(arguments), folder.file(name + ".out"), folder.file(name + ".err")};
  }
  void run_to_end(const std::string& name, const std::vector<std::string>& arguments) {
    run_alone(name, on_bus(arguments));
  }
  /// Without the network.
  void run_alone(const std::string& name, const std::vector<std::string>& arguments) {
    const auto code = run(arguments, folder.file(name + ".out"), folder.file(name + ".err"));
    INFO(read_file(folder.file(name + ".err")));
    REQUIRE(code == 0);
  }
  [[nodiscard]] Process monitor(const std::string& journal) {
    return start("mpmd",
                 {"mpmd", "--config", kUnit, "--journal-every-sample", folder.file(journal)});
  }
  /// The journal, once it is as long as it will be.
  [[nodiscard]] std::string journal(const std::string& name, std::size_t bytes) {
    CHECK(idl::eventually([&] { return read_file(folder.file(name)).size() >= bytes; }, kPatience));
    return read_file(folder.file(name));
  }
  void stop(Process& process, int signal = SIGTERM) {
    process.send(signal);
    CHECK(process.wait(std::chrono::seconds(10)) == 0);
  }

  TemporaryFolder folder;
  idl::DomainOptions domain;
};

void check_three_ways(const std::string& scenario, int seed) {
  constexpr int kSamples = 900;
  CAPTURE(scenario, seed);
  Stage stage("three_ways" + std::to_string(seed));
  const std::vector<std::string> simulate = {"mpmsim",
                                             "--config",
                                             kUnit,
                                             "--scenario",
                                             scenario,
                                             "--seed",
                                             std::to_string(seed),
                                             "--samples",
                                             std::to_string(kSamples),
                                             "--start-time",
                                             "0"};

  // What the journal will be in the end: it tells when everything has arrived.
  std::vector<std::string> to_file = simulate;
  to_file.insert(to_file.end(), {"--csv", stage.folder.file("run.csv")});
  stage.run_alone("sim", to_file);
  stage.run_alone("detect",
                  {"mpm", "detect", "--config", kUnit, "--data", stage.folder.file("run.csv"),
                   "--journal-every-sample", stage.folder.file("expected.jsonl")});
  const std::string expected = read_file(stage.folder.file("expected.jsonl"));

  const std::string recording = stage.folder.file("run.mcap");
  {
    Process monitor = stage.monitor("live.jsonl");
    Process recorder =
        stage.start("record", {"mpm", "record", "--unit", "shell", "--output", recording});
    std::vector<std::string> to_bus = simulate;
    to_bus.insert(to_bus.end(), {"--speed", "0", "--wait-readers", "20", "--readers", "2"});
    stage.run_to_end("bus", to_bus);
    const bool live_same = stage.journal("live.jsonl", expected.size()) == expected;
    CHECK(live_same);  // not printed: megabytes
    stage.stop(recorder, SIGINT);
    stage.stop(monitor);
    INFO(read_file(stage.folder.file("record.err")));
    CHECK(read_file(stage.folder.file("record.err")).find(" 0 dropped") != std::string::npos);
  }
  stage.run_alone("detect", {"mpm", "detect", "--config", kUnit, "--data", recording,
                             "--journal-every-sample", stage.folder.file("detect.jsonl")});
  const bool detect_same = read_file(stage.folder.file("detect.jsonl")) == expected;
  CHECK(detect_same);
  for (const std::string rate : {"1", "100", "0"}) {
    CAPTURE(rate);
    const std::string name = "replay" + rate + ".jsonl";
    Process monitor = stage.monitor(name);
    stage.run_to_end("replay", {"mpm", "replay", recording, "--rate", rate});
    const bool replay_same = stage.journal(name, expected.size()) == expected;
    CHECK(replay_same);
    stage.stop(monitor);
  }
}

std::vector<std::int64_t> mv_intervals_in(const std::string& path) {
  std::vector<std::int64_t> intervals;
  const auto messages = mcap::open_messages(path);
  mcap::Message message;
  while (messages->next(message))
    if (message.channel->topic == "mpm/mv")
      intervals.push_back(idl::stamp_of(message.data).value().interval);
  return intervals;
}

idl::UnitPublisher toy_publisher(const idl::Participant& participant,
                                 idl::WriterPace pace = idl::WriterPace::kRealTime) {
  UnitLayout layout;
  layout.unit = "toy";
  layout[SignalKind::kMv].tags = {"u1", "u2"};
  layout[SignalKind::kCv].tags = {"y1"};
  return {participant, layout, pace};
}

// In an open chunk; a message has 31 bytes beside its data, and each frame two of them.
constexpr std::size_t kChunkBytes = 4096, kMostLost = kChunkBytes / (2 * 31);

/// In the middle of what comes, or once no more comes.
void check_killed_recorder(std::mt19937& random, bool idle) {
  Stage stage("killed" + std::to_string(random()));
  const std::string recording = stage.folder.file("run.mcap");
  const std::string mended = stage.folder.file("mended.mcap");
  Process recorder = stage.start("record", {"mpm", "record", "--output", recording, "--chunk-size",
                                            std::to_string(kChunkBytes), "--chunk-duration", "1h"});
  const idl::Participant participant(stage.domain);
  const idl::UnitPublisher publisher = toy_publisher(participant, idl::WriterPace::kLossless);
  REQUIRE(publisher.wait_for_readers(kPatience));
  const std::size_t frames = 1000 + random() % 1000;
  CAPTURE(frames, idle);
  Plant plant(2.0);
  for (std::size_t k = 0; k < frames; ++k) REQUIRE(publisher.publish(plant.next()));
  const auto count_mended = [&] {
    static_cast<void>(mcap::recover(recording, mended));
    return mv_intervals_in(mended).size();
  };
  if (idle)  // its full chunks are in the file without its being told to end
    CHECK(idl::eventually([&] { return count_mended() + kMostLost >= frames; }, kPatience));
  recorder.send(SIGKILL);
  CHECK(recorder.wait(std::chrono::seconds(5)) == 128 + SIGKILL);

  stage.run_alone("recover", {"mpm", "recover", recording, "--output", mended});
  const std::vector<std::int64_t> intervals = mv_intervals_in(mended);
  for (std::size_t i = 0; i < intervals.size(); ++i)
    REQUIRE(intervals[i] == static_cast<std::int64_t>(i) + 1);
  CHECK(intervals.size() <= frames);
  if (idle) CHECK(intervals.size() + kMostLost >= frames);
}

}  // namespace

TEST_CASE("a recorder loses none of 10 000 samples a second from a writer that waits for nobody") {
  constexpr int kFrames = 10'000, kLayouts = 2;  // two samples per frame, for two seconds
  Stage stage("fast");
  const std::string recording = stage.folder.file("run.mcap");
  Process recorder = stage.start("record", {"mpm", "record", "--output", recording});
  const idl::Participant participant(stage.domain);
  const idl::UnitPublisher publisher = toy_publisher(participant);
  REQUIRE(publisher.wait_for_readers(kPatience));
  Plant plant(2.0);
  Clock::time_point next = Clock::now();
  for (int k = 0; k < kFrames; ++k) {
    REQUIRE(publisher.publish(plant.next()));
    if (k % 5 != 4) continue;
    next += std::chrono::milliseconds(1);
    std::this_thread::sleep_until(next);
  }
  REQUIRE(publisher.flush(kPatience));
  stage.stop(recorder);
  const std::string said = read_file(stage.folder.file("record.err"));
  INFO(said);
  CHECK(said.find(" " + std::to_string(2 * kFrames + kLayouts) + " samples ") != std::string::npos);
  CHECK(said.find(" 0 dropped") != std::string::npos);
  CHECK(mv_intervals_in(recording).size() == kFrames);
}

TEST_CASE("what fits on a disk is a whole recording, and the rest is counted as dropped") {
  constexpr int kFrames = 3000, kLayouts = 2;
  constexpr rlim_t kMostBytes = 150'000;
  // What may stay free: a chunk of 20 kB that did not fit with its index, of 16 bytes per message
  // of 60 and more.
  constexpr rlim_t kChunkRoom = 30'000;
  Stage stage("full");
  const std::string recording = stage.folder.file("run.mcap");
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
  const auto on_signal = std::signal(SIGXFSZ, SIG_IGN);  // the recorder inherits both
  const rlimit small{kMostBytes, before.rlim_max};
  REQUIRE(setrlimit(RLIMIT_FSIZE, &small) == 0);
  Process recorder = stage.start("record", {"mpm", "record", "--output", recording, "--chunk-size",
                                            "20kB", "--compression", "none"});
  REQUIRE(setrlimit(RLIMIT_FSIZE, &before) == 0);
  std::signal(SIGXFSZ, on_signal);
  const idl::Participant participant(stage.domain);
  const idl::UnitPublisher publisher = toy_publisher(participant);
  REQUIRE(publisher.wait_for_readers(kPatience));
  Plant plant(2.0);
  for (int k = 0; k < kFrames; ++k) REQUIRE(publisher.publish(plant.next()));
  REQUIRE(publisher.flush(kPatience));
  CHECK(recorder.wait(kPatience) == 2);
  const std::string said = read_file(stage.folder.file("record.err"));
  INFO(said);
  std::smatch totals;
  REQUIRE(std::regex_search(said, totals, std::regex("  (\\d+) samples  .*  (\\d+) dropped")));
  const int samples = std::stoi(totals[1]), dropped = std::stoi(totals[2]);
  CHECK(samples + dropped <= 2 * kFrames + kLayouts);  // it ends when it notices
  CHECK(dropped > 0);
  stage.run_alone("info", {"mpm", "info", "--json", recording});
  const std::string info = read_file(stage.folder.file("info.out"));
  INFO(info);
  CHECK(info.find("\"whole\":true") != std::string::npos);
  CHECK(info.find("\"index\":\"intact\"") != std::string::npos);
  CHECK(info.find("\"messages\":{\"count\":" + std::to_string(samples) + ",") != std::string::npos);
  CHECK(std::filesystem::file_size(recording) <= kMostBytes);
  CHECK(std::filesystem::file_size(recording) + kChunkRoom > kMostBytes);
}

TEST_CASE("a recording gives the same bytes live, replayed at any speed, and in mpm detect",
          "[rehearse]") {
  for (int i = 0; i < runs(2); ++i) check_three_ways(i % 2 == 0 ? "hidden_gain" : "none", 5 + i);
}

TEST_CASE("a recorder that is killed loses no more than its open chunk", "[rehearse]") {
  std::mt19937 random(1);
  for (int i = 0; i < runs(2); ++i) check_killed_recorder(random, i % 2 == 0);
}

}  // namespace mpm::test::record_test
