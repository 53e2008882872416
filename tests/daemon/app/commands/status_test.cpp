#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/system/process.hpp"

namespace mpm::test {

// The codes of the Monitoring Plugins guidelines: 2 critical, 3 unknown.
TEST_CASE("mpm status says one line, whatever happens") {
  const TemporaryFolder folder;
  const std::string out = folder.file("out"), err = folder.file("err");
  CHECK(
      run({"mpm", "status", "--domain", "7", "--partition", "status-test-nobody", "--wait", "0.3"},
          out, err) == 2);
  CHECK(read_file(out) == "MPM CRITICAL: no monitor on domain 7, partition 'status-test-nobody'\n");
  CHECK(run({"mpm", "status", "--config", folder.file("none.yaml")}, out, err) == 3);
  CHECK(read_file(out).find("MPM UNKNOWN: ") == 0);
  CHECK(run({"mpm", "status", "--interface", "nosuchnic0"}, out, err) == 3);
  CHECK(lines_of(read_file(out)).size() == 1);
  CHECK(read_file(err).empty());
  for (const std::string option : {"--wait=soon", "--no-such-option", "left"}) {
    CAPTURE(option);
    CHECK(run({"mpm", "status", option}, out, err) == 3);
    CHECK(read_file(out).find("MPM UNKNOWN: bad usage: ") == 0);
    CHECK(lines_of(read_file(out)).size() == 1);
  }
  CHECK(run({"mpm", "watch", "--no-such-option"}, out, err) == 3);
  CHECK(read_file(out).empty());
}

TEST_CASE("mpm status asks for every unit where its file says") {
  const TemporaryFolder folder;
  const std::string out = folder.file("out"), err = folder.file("err");
  std::filesystem::create_directory(folder.file("units"));
  for (const std::string unit : {"one", "two"})
    write_file(folder.file("units/" + unit + ".yaml"),
               "unit: " + unit + "\nsample_time: 1\nsignals: {mv: [u], cv: [y]}\n" +
                   "model: {channels: [{cv: y, mv: u, gain: 2, time_constants: [5]}]}\n" +
                   "dds: {domain: 7, partition: status-" + unit + "-" + std::to_string(getpid()) +
                   "}\n");
  const Process monitor({"mpmd", "--config", folder.file("units")}, folder.file("mpmd.out"),
                        folder.file("mpmd.err"));
  const auto said = [&](std::vector<std::string> options) {
    options.insert(options.begin(),
                   {"mpm", "status", "--config", folder.file("units"), "--wait", "5"});
    static_cast<void>(run(options, out, err));
    return read_file(out);
  };
  const std::string both = said({});
  INFO(both);
  CHECK(both.find("one: ") != std::string::npos);
  CHECK(both.find("two: ") != std::string::npos);
  CHECK(both.find("no monitor") == std::string::npos);
  const std::string second = said({"--unit", "two"});
  CHECK(second.find("two: ") != std::string::npos);
  CHECK(second.find("no monitor") == std::string::npos);
  CHECK(second.find("one") == std::string::npos);
}

}  // namespace mpm::test
