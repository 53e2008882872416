#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/daemon/bag/bench.hpp"

namespace mpm::test {

TEST_CASE("mpm list tells what lies in a folder, in lines or JSON") {
  Bench bench;
  const auto list = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"mpm", "list"});
    return run(arguments, bench.folder.file("out"), bench.folder.file("err"));
  };
  std::filesystem::create_directory(bench.folder.file("runs"));
  CHECK(list({bench.folder.file("runs")}) == 0);
  CHECK(bench.text("out").empty());
  CHECK(bench.text("err").find("no recording") != std::string::npos);

  write_file(bench.folder.file("run.csv"), "time,u,y\n0,1,2\n60,1,2\n120,1,3\n");
  static_cast<void>(bench.convert("run.csv", "runs/run.mcap", bench.with_unit()));
  CHECK(list({bench.folder.file("runs")}) == 0);
  const std::string line = bench.text("out");
  CHECK(line.starts_with("run.mcap  1970-01-01T00:00:00Z  2.0 min  "));
  CHECK(line.find("  small  whole\n") != std::string::npos);
  CHECK(list({bench.folder.file("runs"), "--json"}) == 0);
  const auto json = nlohmann::json::parse(bench.text("out"));
  REQUIRE(json.size() == 1);
  CHECK(json[0]["name"] == "run.mcap");
  CHECK(json[0]["units"] == nlohmann::json::array({"small"}));
  CHECK(list({bench.folder.file("nowhere")}) == 3);
}

}  // namespace mpm::test
