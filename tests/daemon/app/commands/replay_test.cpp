#include <catch2/catch.hpp>

#include "tests/daemon/bag/bench.hpp"

namespace mpm::test {

// Nothing of this gets as far as the bus.
TEST_CASE("mpm replay refuses what chooses nothing, and says which option it was") {
  Bench bench;
  write_file(bench.folder.file("run.csv"), "time,u,y\n0,1,2\n60,1,2\n120,1,3\n");
  static_cast<void>(bench.convert("run.csv", "run.mcap", bench.with_unit()));
  const auto refusal = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"mpm", "replay", bench.folder.file("run.mcap")});
    CHECK(run(options, bench.folder.file("out"), bench.folder.file("err")) == 3);
    return bench.text("err");
  };
  CHECK(refusal({"--regex", "mpm/("}).find("--regex: 'mpm/(' is no regular") != std::string::npos);
  CHECK(refusal({"--regex", "valve"}).find("matches no topic") != std::string::npos);
  CHECK(refusal({"--exclude-topics", "mpm/mx"}).find("no topic 'mpm/mx'") != std::string::npos);
  CHECK(refusal({"--exclude-regex", "."}).find("all topics chosen are excl") != std::string::npos);
  CHECK(refusal({"--regex", "health"}).find("holds no sample of mpm/health") != std::string::npos);
  CHECK(refusal({"--remap", "small:=a\nb"}).find("--remap: 'a\\nb' has what no unit") !=
        std::string::npos);
  CHECK(refusal({"--rate", "nan"}).find("'nan' is no number from 0 on") != std::string::npos);
  CHECK(refusal({"--playback-until", "noon"}).find("'noon' is neither a time") !=
        std::string::npos);
  CHECK(refusal({"--playback-until", "1969-12-31T23:00:00Z"})
            .find("the recording begins at 1970-01-01T00:00:00Z") != std::string::npos);
  CHECK(refusal({"--playback-until", "30", "--start-offset", "1min"}).find("no sample lies in") !=
        std::string::npos);
}

}  // namespace mpm::test
