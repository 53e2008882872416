#include <catch2/catch.hpp>

#include "tests/system/process.hpp"

namespace mpm::test::full_output_test {
namespace {

const std::string kUnit = MPM_SOURCE_DIR "/config/plants/shell3x3.yaml";

}  // namespace

TEST_CASE("every program says in one line that its output could not be written") {
  TemporaryFolder folder;
  write_file(folder.file("wrong.yaml"), "unit: toy\n");
  REQUIRE(run({"mpmsim", "--config", kUnit, "--samples", "30", "--csv", folder.file("run.csv")},
              folder.file("out"), folder.file("err")) == 0);
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"mpmd", "--config", kUnit, "--print-config"},
           {"mpmd", "--config", folder.file("wrong.yaml"), "--check"},
           {"mpmd", "--version"},
           {"mpmd", "--help"},
           {"mpmsim", "--help"},
           {"mpmsim", "--config", kUnit, "--samples", "30", "--csv", "-"},
           {"mpm", "--help"},
           {"mpm", "info", folder.file("run.csv")},
           {"mpm", "convert", folder.file("run.csv"), "-"},
           {"mpm", "detect", "--config", kUnit, "--data", folder.file("run.csv")},
           {"mpm", "detect", "--config", kUnit, "--data", folder.file("run.csv"), "--json"}}) {
    CAPTURE(command);
    CHECK(run(command, "/dev/full", folder.file("err")) == 2);
    const std::string said = read_file(folder.file("err"));
    CAPTURE(said);
    CHECK(lines_of(said).size() == 1);
    CHECK(said.find(": error: ") != std::string::npos);
  }
}

}  // namespace mpm::test::full_output_test
