#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/system/process.hpp"

namespace mpm::test {

TEST_CASE("no command writes over what it reads") {
  const TemporaryFolder folder;
  const std::string unit = folder.file("extended.yaml"), data = folder.file("data.csv");
  const std::string unit_text =
      "unit: small\nsample_time: 1\nsignals: {mv: u, cv: y}\n"
      "model: {channels: [{cv: y, mv: u, gain: 2, time_constants: [8]}]}\n";
  const std::string rows = "time,u,y\n0,1,2\n1,1,2\n2,1,2\n";
  write_file(unit, unit_text);
  write_file(data, rows);
  std::filesystem::create_symlink(unit, folder.file("link.yaml"));
  const auto refused = [&](std::vector<std::string> command, const std::string& output) {
    CAPTURE(command);
    CHECK(run(command, folder.file("out"), folder.file("err")) == 3);
    CHECK(read_file(folder.file("err")) == output + ": error: is the file that is read\n");
    CHECK(read_file(unit) == unit_text);
    CHECK(read_file(data) == rows);
  };
  const std::string here = std::filesystem::path(unit).parent_path();
  const std::string link = folder.file("link.yaml");
  refused({"mpm", "identify", "--config", unit, "--data", data, "--out", unit}, unit);
  refused({"mpm", "identify", "--config", unit, "--data", data, "--out", link}, link);
  refused({"mpm", "identify", "--config", unit, "--data", data, "--out", data}, data);
  refused({"mpm", "import", data, "--config", unit, "--out", unit}, unit);
  refused({"mpm", "import", data, "--config", unit, "--out", data}, data);
  refused({"mpm", "diagnose", "--config", unit, "--data", data, "--out", here}, unit);
  refused({"mpm", "trend", "--config", unit, "--data", data, "--csv", data}, data);
  refused({"mpm", "trend", "--config", unit, "--data", data, "--svg", unit}, unit);
  refused({"mpm", "detect", "--config", unit, "--data", data, "--journal-every-sample", data},
          data);
  refused({"mpm", "convert", data, unit, "--config", unit}, unit);
  refused({"mpmsim", "--config", unit, "--csv", unit}, unit);
  refused({"mpmsim", "--config", unit, "--csv", folder.file("run.csv"), "--truth", unit}, unit);

  const std::string both = folder.file("both");
  CHECK(run({"mpm", "trend", "--config", unit, "--data", data, "--csv", both, "--svg", both},
            folder.file("out"), folder.file("err")) == 3);
  CHECK(read_file(folder.file("err")) == both + ": error: is given for two outputs\n");
}

}  // namespace mpm::test
