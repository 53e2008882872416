#include <catch2/catch.hpp>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "config/load_unit.hpp"
#include "config/scenario_config.hpp"
#include "core/model/linear_model.hpp"
#include "tests/config/extended_unit.hpp"

namespace mutation_test {

using namespace mpm::config;

namespace {

std::string read_file(const std::string& name) {
  std::ifstream file(std::string(MPM_SOURCE_DIR) + "/config/" + name);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// One to eight random slips: bytes changed, removed, inserted, pieces copied elsewhere.
std::string mutated(std::string text, std::mt19937_64& random) {
  static const std::vector<std::string> kPieces = {
      ":",   " ",  "\n",  "- ",    "{",    "}",     "[",   "]",  ",",        "#",    "\"", "'",
      "&a ", "*a", "<<:", "!!x ",  "|\n",  "---\n", "...", "%",  "? ",       "\t",   "~",  ".nan",
      "-1",  "0",  "1e9", "1e400", "null", "true",  "{}",  "[]", "\xff\xfe", "\xc3", "u1", "y1"};
  const auto below = [&random](std::size_t bound) {
    return static_cast<std::size_t>(random() % (bound == 0 ? 1 : bound));
  };
  for (std::size_t slips = 1 + below(8); slips > 0; --slips) {
    const std::size_t at = below(text.size());
    switch (below(5)) {
      case 0:
        if (!text.empty()) text[at] = static_cast<char>(random());
        break;
      case 1:
        text.erase(at, 1 + below(20));
        break;
      case 2:
        text.insert(at, kPieces[below(kPieces.size())]);
        break;
      case 3:
        text.insert(at, text.substr(below(text.size()), below(60)));
        break;
      default:
        text.resize(at);
    }
  }
  return text;
}

/// Findings must have a file and a place inside it or none.
void check_findings(const std::vector<Finding>& findings) {
  for (const Finding& finding : findings)
    if (finding.file != "m.yaml" || finding.line < 0 || finding.message.empty())
      FAIL_CHECK(format(finding));
}

}  // namespace

TEST_CASE("No slip of the pen brings the unit loader down, and what it takes it can print") {
  constexpr std::uint64_t kSeed = 20240501;
  std::mt19937_64 random(kSeed);
  const std::vector<std::string> originals = {
      read_file("plants/shell3x3.yaml"), read_file("plants/wood_berry.yaml"),
      read_file("units/example.yaml"), mpm::test::kExtendedUnit};
  int sound = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string text =
        mutated(originals[static_cast<std::size_t>(i) % originals.size()], random);
    const LoadResult result = load_unit_text(text, "m.yaml");
    check_findings(result.findings);
    if (!result.ok()) continue;
    ++sound;
    REQUIRE_NOTHROW(mpm::LinearModel(result.config.model));
    std::ostringstream once, twice;
    print_unit(result.config, once);
    const LoadResult again = load_unit_text(once.str(), "m.yaml");
    INFO("seed " << kSeed << ", round " << i << "\n" << text << "\n" << once.str());
    REQUIRE(again.ok());
    print_unit(again.config, twice);
    REQUIRE(once.str() == twice.str());
  }
  CHECK(sound > 50);  // slips in comments and numbers
}

TEST_CASE("No slip of the pen brings the scenario loader down") {
  std::mt19937_64 random(20240502);
  const UnitConfig unit =
      load_unit_text(read_file("plants/shell3x3_ambient.yaml"), "u.yaml").config;
  const std::vector<std::string> originals = {
      read_file("scenarios/s4_gain40.yaml"),          read_file("scenarios/hidden_gain.yaml"),
      read_file("scenarios/constant_setpoints.yaml"), read_file("scenarios/all_events.yaml"),
      read_file("scenarios/lagged_step.yaml"),        read_file("scenarios/controller_off.yaml"),
      read_file("scenarios/constrained.yaml"),        read_file("scenarios/bad_data.yaml"),
      read_file("scenarios/sticking_valve.yaml"),     read_file("scenarios/unmodelled_input.yaml")};
  for (int i = 0; i < 6000; ++i) {
    const std::string text =
        mutated(originals[static_cast<std::size_t>(i) % originals.size()], random);
    check_findings(load_scenario_text(text, "m.yaml", unit, 3000.0).findings);
  }
}

TEST_CASE("Deep nesting and cycles are findings, not a crash") {
  CHECK_FALSE(load_unit_text(std::string(100000, '['), "m.yaml").ok());
  CHECK_FALSE(load_unit_text(std::string(100000, '{'), "m.yaml").ok());
  std::string nested;
  for (int i = 0; i < 3000; ++i) nested += "- ";
  CHECK_FALSE(load_unit_text(nested, "m.yaml").ok());
  // A document that ends early: YAML::LoadAll reads this for ever.
  CHECK_FALSE(load_unit_text("a: [1\nb: 2\n, c\n", "m.yaml").ok());
  CHECK_FALSE(load_unit_text("unit: &a [*a]\nsignals: &b {mv: *b, cv: *b}\n", "m.yaml").ok());
}

}  // namespace mutation_test
