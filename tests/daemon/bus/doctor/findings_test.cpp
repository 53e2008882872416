#include "daemon/bus/doctor/findings.hpp"

#include <catch2/catch.hpp>

namespace mpm::bus {
namespace {

/// A unit whose gateway leaves mpm/dv out, and an HMI that asks for what no monitor offers.
Findings sick() {
  Findings findings;
  findings.place = "domain 3";
  UnitFindings& unit = findings.units.emplace_back();
  unit.unit = "toy";
  unit.monitors = {{{"plant1", "mpmd", "9"}, "failure", "nothing on mpm/dv", 0, 0.5}};
  unit.topics = {{"mpm/mv", true, {{{"plant2", "gateway", "7"}, {}, 6, 1.0, 0.25, -0.5, 2, 3}}},
                 {"mpm/dv", true, {}}};
  unit.troubles = {{"silent mpm/dv", Severity::kFailure, "nothing on mpm/dv (nobody writes it)"}};
  findings.troubles = {{"mismatch", Severity::kMaintenanceRequired, "hmi reads mpm/alarm"}};
  findings.notes = {"CYCLONEDDS_URI is set and was not used"};
  return findings;
}

}  // namespace

TEST_CASE("the doctor's text has a line per writer and one per trouble, the worst first") {
  CHECK_FALSE(sick().all_well());
  CHECK(to_text(sick()) ==
        "toy: trouble\n"
        "  monitor        mpmd (process 9 on host plant1): failure (nothing on mpm/dv), 0.5 s ago\n"
        "  mpm/mv         gateway (process 7 on host plant2): QoS matches, 1/s, last 0.2 s ago, "
        "clock +0.500 s, 2 skipped, 3 repeated\n"
        "  mpm/dv         nobody writes it\n"
        "\n"
        "1. toy: nothing on mpm/dv (nobody writes it). Let the gateway publish it, or take its "
        "signals out of the unit file.\n"
        "2. hmi reads mpm/alarm. Give it the QoS of docs/hmi.md.\n"
        "note: CYCLONEDDS_URI is set and was not used\n");
}

TEST_CASE("the doctor's JSON holds the same") {
  const nlohmann::ordered_json json = to_json(sick());
  CHECK(json["all_well"] == false);
  CHECK(json["units"][0]["monitors"][0]["state"] == "failure");
  const auto& writer = json["units"][0]["topics"][0]["writers"][0];
  CHECK(writer["program"] == "gateway");
  CHECK(writer["qos_matches"] == true);
  CHECK(writer["skipped"] == 2);
  CHECK(json["troubles"][0]["unit"] == "toy");
  CHECK(json["troubles"][0]["severity"] == "failure");
  CHECK(json["troubles"].size() == 2);
}

TEST_CASE("findings of several places are told as one, each with its place") {
  Findings other = sick();
  other.place = "domain 4";
  other.units[0].unit = "toy2";
  CHECK(to_text(joined({sick()})) == to_text(sick()));
  const Findings both = joined({sick(), other});
  CHECK(both.place == "domain 3; domain 4");
  CHECK_FALSE(both.all_well());
  const std::string text = to_text(both);
  CHECK(text.find("toy on domain 3: trouble\n") == 0);
  CHECK(text.find("toy2 on domain 4: trouble\n") != std::string::npos);
  CHECK(text.find("domain 4: hmi reads mpm/alarm") != std::string::npos);
  CHECK(text.find("note: domain 3: CYCLONEDDS_URI") != std::string::npos);
  CHECK(to_json(both)["units"][1]["place"] == "domain 4");
}

TEST_CASE("nothing that somebody on the bus made up gets to the terminal as it is") {
  const std::string evil = "\x1b[31mX\n\xff\xc2\x9b";
  Findings findings = sick();
  UnitFindings& unit = findings.units[0];
  unit.unit = unit.monitors[0].state = unit.monitors[0].detail = evil;
  unit.troubles[0].text = evil;
  findings.notes = {evil};
  for (const bool well : {false, true}) {
    if (well) {
      unit.troubles.clear();
      findings.troubles.clear();
      unit.monitors[0].state = "function_check";
    }
    const std::string text = to_text(findings);
    CAPTURE(text);
    CHECK(text.find(well ? ": \\x1b[31mX\\n\\xff\\u{9b}" : "1. \\x1b[31mX\\n\\xff\\u{9b}: ") !=
          std::string::npos);
    for (const char* raw : {"\x1b", "\xff", "\x9b", "X\n"})
      CHECK(text.find(raw) == std::string::npos);
  }
}

TEST_CASE("where nothing is wrong the doctor says so") {
  Findings findings = sick();
  findings.troubles.clear();
  findings.units[0].troubles.clear();
  CHECK(findings.all_well());
  CHECK(to_text(findings).find("toy: well\n") == 0);
  CHECK(to_text(findings).find("all is well on domain 3\n") != std::string::npos);
  findings.units[0].monitors[0].active_alarms = 2;
  CHECK(to_text(findings).find("the data path is well on domain 3; 2 alarms: see mpm watch\n") !=
        std::string::npos);
  findings.units[0].monitors[0].silenced_alarms = 1;
  CHECK(to_text(findings).find("on domain 3; 1 alarm: see mpm watch\n") != std::string::npos);
  findings.units[0].monitors[0].silenced_alarms = 2;
  CHECK(to_text(findings).find("all is well on domain 3\n") != std::string::npos);
  findings.units[0].monitors[0] = {{}, "function_check", "nothing determined yet", 0, 0.5};
  CHECK(
      to_text(findings).find("the data path is well on domain 3; toy: nothing determined yet\n") !=
      std::string::npos);
}

}  // namespace mpm::bus
