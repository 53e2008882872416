#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/daemon/bag/bench.hpp"

namespace mpm::test {

TEST_CASE("mpm record refuses a choice that means nothing, and writes nothing") {
  Bench bench;
  const auto refusal = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"mpm", "record", "--duration", "0.1"});
    CHECK(run(options, bench.folder.file("out"), bench.folder.file("err")) == 3);
    return bench.text("err");
  };
  const std::string ring = bench.folder.file("ring");
  CHECK(refusal({"--output", ring, "--regex", "["}).find("--regex: '['") != std::string::npos);
  CHECK(refusal({"--output", ring, "--exclude-regex", "mpm"}).find("excluded") !=
        std::string::npos);
  CHECK(refusal({"--output", ring, "--snapshot", "--topics", "mpm/mv"})
            .find("mpm/alarm_event is not among the topics") != std::string::npos);
  CHECK(refusal({"--output", ring + ".mcap", "--snapshot"}).find("has to be a folder") !=
        std::string::npos);
  CHECK(refusal({"--output", ring, "--snapshot-after", "10min"}).find("--snapshot") !=
        std::string::npos);
  CHECK_FALSE(std::filesystem::exists(ring));
  CHECK(run({"mpm", "record", "--output", "/dev/full"}, bench.folder.file("out"),
            bench.folder.file("err")) == 2);
  CHECK(bench.text("err").starts_with(
      "mpm: error: /dev/full: a folder of that name cannot be made: "));
}

}  // namespace mpm::test
