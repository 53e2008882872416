#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>

#include "daemon/mcap/read/file_sequence.hpp"
#include "tests/system/bench.hpp"

namespace mpm::test::snapshot_test {
namespace {

namespace fs = std::filesystem;
constexpr std::chrono::seconds kPatience{20};

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  if (!fs::exists(folder)) return names;
  for (const auto& entry : fs::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  return names;
}

std::size_t samples_of(const std::string& topic, const std::string& folder) {
  std::size_t count = 0;
  mcap::FileSequence messages({folder});
  mcap::Message message;
  while (messages.next(message))
    if (message.channel->topic == topic) ++count;
  return count;
}

}  // namespace

TEST_CASE("an alarm and a signal save what the recorder has of the time around them") {
  constexpr int kFrames = 3000;
  Bench bench("snapshot");
  const std::string ring = bench.folder.file("ring"), said = bench.folder.file("record.err");
  Process recorder({"mpm", "record", "--output", ring, "--snapshot", "--snapshot-before", "1min",
                    "--snapshot-after", "1", "--domain", std::to_string(bench.options.domain),
                    "--partition", bench.options.partition},
                   bench.folder.file("record.out"), said);
  const auto has_said = [&](const std::string& text) {
    return idl::eventually([&] { return read_file(said).find(text) != std::string::npos; },
                           kPatience);
  };
  REQUIRE(has_said("recording to"));
  const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kLossless);
  REQUIRE(publisher.wait_for_readers(kPatience, 2));  // mpmd and recorder
  Plant wrong(4.0);                                   // where the model says 2
  bench.publish(publisher, wrong, kFrames);
  REQUIRE(bench.observe([&] { return bench.health().active_alarms == 1; }));
  CHECK(has_said("saved " + ring + "/saved/toy-u1-y1-"));
  {
    INFO(read_file(said));
    const std::vector<std::string> saved = names_in(ring + "/saved");
    REQUIRE(saved.size() == 1);
    CHECK(saved[0].starts_with("toy-u1-y1-"));
    CHECK(samples_of("mpm/alarm_event", ring + "/saved/" + saved[0]) >= 1);
    CHECK(samples_of("mpm/mv", ring + "/saved/" + saved[0]) > 0);
  }
  recorder.send(SIGUSR1);
  CHECK(has_said("saved " + ring + "/saved/by-hand-"));
  recorder.send(SIGINT);
  CHECK(recorder.wait(kPatience) == 0);
  INFO(read_file(said));
  const std::vector<std::string> saved = names_in(ring + "/saved");
  REQUIRE(saved.size() == 2);
  const std::string& by_hand = saved[0].starts_with("by-hand-") ? saved[0] : saved[1];
  CHECK(samples_of("mpm/mv", ring + "/saved/" + by_hand) == kFrames);
  CHECK(samples_of("mpm/mv", ring) == kFrames);
}

}  // namespace mpm::test::snapshot_test
