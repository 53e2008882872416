#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/system/process.hpp"

namespace mpm::test::detect_nonlinear_test {
namespace {

const std::string kUnit = MPM_SOURCE_DIR "/config/plants/shell3x3.yaml";

int detect(const TemporaryFolder& folder, const std::string& unit, const std::string& data,
           const std::vector<std::string>& options) {
  std::vector<std::string> arguments = {"mpm",    "detect",          "--config", unit,
                                        "--data", folder.file(data), "--json"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return run(arguments, folder.file("out"), folder.file("err")).value_or(-1);
}

nlohmann::json answer(const TemporaryFolder& folder, const std::string& unit,
                      const std::string& data, const std::vector<std::string>& options) {
  REQUIRE(detect(folder, unit, data, options) == 0);
  return nlohmann::json::parse(read_file(folder.file("out")));
}

nlohmann::json without_nonlinear(nlohmann::json said) {
  for (nlohmann::json& channel : said["channels"]) channel.erase("nonlinear");
  return said;
}

/// The file's text with another nonlinear test in it.
std::string unit_with(const std::string& test) {
  std::string text = read_file(kUnit);
  const std::string empty = "monitor: {}";
  return text.replace(text.find(empty), empty.size(), "monitor: {nonlinear: " + test + "}");
}

TEST_CASE("mpm detect asks a recording with another nonlinear test than the unit file's") {
  const TemporaryFolder folder;
  REQUIRE(run({"mpmsim", "--config", kUnit, "--scenario", "quadratic_valve", "--seed", "1",
               "--samples", "2000", "--csv", folder.file("run.csv")},
              folder.file("sim.out"), folder.file("sim.err")) == 0);
  REQUIRE(
      run({"mpm", "convert", folder.file("run.csv"), folder.file("run.mcap"), "--config", kUnit},
          folder.file("convert.out"), folder.file("convert.err")) == 0);
  const nlohmann::json usual = answer(folder, kUnit, "run.csv", {});
  CHECK(answer(folder, kUnit, "run.csv", {"--nonlinear", "polynomial"}) == usual);

  for (const std::string test : {"off", "kernel", "random_features"}) {
    CAPTURE(test);
    const nlohmann::json asked = answer(folder, kUnit, "run.csv", {"--nonlinear", test});
    CHECK(asked != usual);
    CHECK(without_nonlinear(asked) == without_nonlinear(usual));  // the linear test stays
    CHECK(asked["channels"][0].contains("nonlinear") == (test != "off"));
    CHECK(answer(folder, kUnit, "run.mcap", {"--nonlinear", test}) == asked);
    write_file(folder.file("unit.yaml"), unit_with(test));
    CHECK(answer(folder, folder.file("unit.yaml"), "run.csv", {}) == asked);
    CHECK(answer(folder, folder.file("unit.yaml"), "run.csv", {"--nonlinear", "polynomial"}) ==
          usual);
  }
  // It has the last word, over a scenario's as well.
  write_file(folder.file("off.yaml"), "monitor: {nonlinear: off}\n");
  CHECK(answer(folder, kUnit, "run.csv",
               {"--scenario", folder.file("off.yaml"), "--nonlinear", "kernel"}) ==
        answer(folder, kUnit, "run.csv", {"--nonlinear", "kernel"}));
}

TEST_CASE("a nonlinear test that there is not is refused with those that there are") {
  const TemporaryFolder folder;
  for (const std::string wrong : {"cubic", "Kernel", ""}) {
    CAPTURE(wrong);
    CHECK(detect(folder, kUnit, "run.csv", {"--nonlinear=" + wrong}) != 0);
    const std::string said = read_file(folder.file("err"));
    CHECK(said.find("--nonlinear") != std::string::npos);
    for (const char* name : {"off", "polynomial", "kernel", "random_features"})
      CHECK(said.find(name) != std::string::npos);
    CHECK(read_file(folder.file("out")).empty());
  }
}

}  // namespace
}  // namespace mpm::test::detect_nonlinear_test
