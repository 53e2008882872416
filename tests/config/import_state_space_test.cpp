#include "config/import_state_space.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "config/load_unit.hpp"

namespace mpm::config::import_state_space_test {
namespace {

UnitConfig unit() {
  const LoadResult loaded =
      load_unit_text("unit: u\nsample_time: 2\nsignals:\n  mv: [{tag: a}]\n  cv: [{tag: y}]\n",
                     "unit.yaml", ModelNeed::kMayBeMissing);
  REQUIRE(loaded.ok());
  return loaded.config;
}

TEST_CASE("a state space of another tool becomes the unit's, if it is made for it") {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("mpm-" + std::to_string(getpid()) + "-model.json");
  const auto import = [&](const std::string& text, UnitConfig& config) {
    std::ofstream(path) << text;
    std::vector<Finding> findings = import_state_space(path.string(), config);
    std::filesystem::remove(path);
    return findings;
  };
  UnitConfig good = unit();
  CHECK(import(R"({"A": [[0.9]], "B": [[0.1]], "C": [[2]], "sample_time": 2, "outputs": ["y"]})",
               good)
            .empty());
  REQUIRE(good.model.state_space);
  CHECK(good.model.state_space->a(0, 0) == 0.9);
  CHECK(good.model.state_space->c(0, 0) == 2.0);

  UnitConfig bad = unit();
  const std::vector<Finding> findings =
      import("{\"A\": [[0.9]], \"B\": [[0.1]], \"C\": [[2]],\n \"sample_time\": 3}", bad);
  REQUIRE(findings.size() == 1);
  CHECK(format(findings[0]).find("model.json:2:17") != std::string::npos);
}

}  // namespace
}  // namespace mpm::config::import_state_space_test
