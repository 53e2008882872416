#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/system/process.hpp"

namespace mpm::test::detect_scenario_test {
namespace {

const std::string kUnit = MPM_SOURCE_DIR "/config/plants/shell3x3.yaml";

nlohmann::json detect(const TemporaryFolder& folder, const std::vector<std::string>& options) {
  std::vector<std::string> arguments = {
      "mpm", "detect", "--config", kUnit, "--data", folder.file("run.csv"), "--json"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  REQUIRE(run(arguments, folder.file("out"), folder.file("err")) == 0);
  return nlohmann::json::parse(read_file(folder.file("out")));
}

TEST_CASE("mpm detect takes the monitor settings of a scenario, and nothing else of it") {
  const TemporaryFolder folder;
  REQUIRE(run({"mpmsim", "--config", kUnit, "--samples", "1000", "--csv", folder.file("run.csv")},
              folder.file("sim.out"), folder.file("sim.err")) == 0);
  const nlohmann::json plain = detect(folder, {});

  // s4_g5 also hides gain errors; they are the simulator's business.
  const nlohmann::json shorter = detect(folder, {"--scenario", "s4_g5"});
  CHECK(shorter["unit"] == plain["unit"]);
  for (std::size_t c = 0; c < 9; ++c) {
    CHECK(shorter["channels"][c]["p_value"] == plain["channels"][c]["p_value"]);
    CHECK(shorter["channels"][c]["partial_correlations"]["values"] !=
          plain["channels"][c]["partial_correlations"]["values"]);
  }
  CHECK(detect(folder, {"--scenario", "none"}) == plain);

  write_file(folder.file("line.yaml"), "monitor: {correlation: partial, threshold: mean_line}\n");
  const nlohmann::json line = detect(folder, {"--scenario", folder.file("line.yaml")});
  for (const nlohmann::json& channel : line["channels"]) {
    CHECK(channel["threshold"] == line["channels"][0]["threshold"]);
    CHECK(channel["statistic"] == std::abs(channel["partial_correlation"].get<double>()));
    CHECK(channel["partial_correlations"]["lags"] == nlohmann::json{-10, 20});
  }

  write_file(folder.file("bad.yaml"), "monitor: {correlation: none}\n");
  CHECK(run({"mpm", "detect", "--config", kUnit, "--data", folder.file("run.csv"), "--scenario",
             folder.file("bad.yaml")},
            folder.file("out"), folder.file("err")) == 3);
  CHECK(read_file(folder.file("err")) ==
        folder.file("bad.yaml") +
            ":1:24: error: monitor.correlation: must be one of lagged_partial, partial, "
            "conventional, alternative, spearman, rank_partial, not 'none'\n");
}

}  // namespace
}  // namespace mpm::test::detect_scenario_test
