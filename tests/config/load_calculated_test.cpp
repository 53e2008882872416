#include <catch2/catch.hpp>
#include <sstream>

#include "config/load_unit.hpp"
#include "config/unit_layout.hpp"

namespace mpm::config {
namespace {

const std::string kHead =
    "unit: u\n"
    "sample_time: 10\n"
    "signals:\n"
    "  mv: [{tag: valve, unit: \"%\"}]\n"
    "  cv: [{tag: heat, unit: K kg/s, setpoint: goal}]\n"
    "  raw: [{tag: flow, unit: kg/s}, {tag: T_supply, unit: K}, {tag: TI-102.PV, unit: K}]\n"
    "  calc:\n";

LoadResult load(const std::string& calc) {
  return load_unit_text(kHead + calc, "u.yaml", ModelNeed::kMayBeMissing);
}

std::string findings(const std::string& calc) {
  std::string text;
  for (const Finding& finding : load(calc).findings) text += format(finding) + '\n';
  return text;
}

TEST_CASE("calculated signals come behind those that they use, and are printed as they were") {
  const LoadResult loaded = load(
      "    heat: flow * rise\n"
      "    rise: {expression: \"T_supply - {TI-102.PV}\", unit: K}\n");
  CHECK(loaded.findings.empty());
  REQUIRE(loaded.config.calc.size() == 2);
  CHECK(loaded.config.calc[0].tag == "rise");
  CHECK(loaded.config.calc[0].inputs == std::vector<std::string>{"T_supply", "TI-102.PV"});
  CHECK(loaded.config.calc[1].unit == "K kg/s");  // the signal's
  std::ostringstream out;
  print_unit(loaded.config, out);
  const LoadResult back = load_unit_text(out.str(), "printed", ModelNeed::kMayBeMissing);
  CHECK(back.findings.empty());
  REQUIRE(back.config.calc.size() == 2);
  CHECK(back.config.calc[0].expression == "T_supply - {TI-102.PV}");
  CHECK(back.config.calc[0].unit == "K");
  CHECK(back.config.raw.size() == 3);
  CHECK(back.config.counts().raw == 3);
}

TEST_CASE("what the control system is to publish leaves out what is calculated") {
  const UnitConfig unit =
      load("    heat: flow * (T_supply - {TI-102.PV})\n    goal: heat / valve\n").config;
  const UnitLayout layout = unit_layout(unit);
  CHECK(layout[SignalKind::kMv].tags == std::vector<std::string>{"valve"});
  CHECK(layout[SignalKind::kCv].tags.empty());
  CHECK(layout[SignalKind::kSetpoint].tags.empty());
  CHECK(layout[SignalKind::kRaw].tags.size() == 3);
  CHECK(is_layout_of(unit, SignalKind::kCv, {"heat"}));
  CHECK(is_layout_of(unit, SignalKind::kCv, {""}));
  CHECK_FALSE(is_layout_of(unit, SignalKind::kMv, {""}));
}

TEST_CASE("mistakes in expressions are told where they stand in the file") {
  CHECK(findings("    heat: flow * (T_suply - {TI-102.PV})\n")
            .find("u.yaml:8:19: error: signals.calc.heat: 'T_suply' is no tag of this unit (did "
                  "you mean 'T_supply'?)\n") == 0);
  // Quoted, with an escape before it; folded over two lines.
  CHECK(findings("    heat: \"flow *\\t(T_suply - {TI-102.PV})\"\n").find("u.yaml:8:21: error: ") ==
        std::string::npos);  // a control character is refused as such
  CHECK(findings("    heat: \"flow * (T_suply - {TI-102.PV})\"\n").find("u.yaml:8:20: error: ") ==
        0);
  CHECK(findings("    heat: flow *\n      (T_suply - {TI-102.PV})\n").find("u.yaml:9:8: error: ") ==
        0);
  CHECK(findings("    heat: >-\n      flow *\n      (T_suply - {TI-102.PV})\n")
            .find("u.yaml:10:8: error: ") == 0);
  CHECK(findings("    heat: flow * (T_supply - TI-102.PV)\n")
            .find("u.yaml:8:37: error: signals.calc.heat: a sign is missing behind the number, or "
                  "braces around a tag") == 0);
  CHECK(findings("    heat: flow * (T_supply - TI)\n")
            .find("'TI' is no tag of this unit; write 'TI-102.PV' in braces: {TI-102.PV}") !=
        std::string::npos);
  CHECK(findings("    heat: flow * outdoor_temperature\n").find("stands in `raw`") !=
        std::string::npos);
  CHECK(findings("    heat: flow * (T_supply\n").find("u.yaml:8:27: error: ") == 0);
  CHECK(findings("    heat: [1]\n").find("must be a text") != std::string::npos);
  CHECK(findings("    heat: {unit: K}\n").find("`expression` is missing") != std::string::npos);
  CHECK(findings("    flow: 2 * T_supply\n").find("is calculated, so it is not `raw`") !=
        std::string::npos);
  CHECK(findings("    heat: " + std::string(1'000'000, '1') + "\n")
            .find("is longer than 4000 bytes") != std::string::npos);
}

TEST_CASE("a circle of calculations is an error where it closes") {
  const std::string text = findings(
      "    heat: flow * a\n"
      "    a: b + T_supply\n"
      "    b: \"2 * a - {TI-102.PV}\"\n");
  INFO(text);
  CHECK(text.find("u.yaml:10:13: error: signals.calc.b: 'a' is calculated from itself: a <- b <- "
                  "a\n") == 0);
  CHECK(findings("    heat: heat + flow * (T_supply - {TI-102.PV})\n").find("heat <- heat") !=
        std::string::npos);
  std::string chain = "    heat: flow * (T_supply - {TI-102.PV}) + c0\n";
  for (int i = 0; i < 1200; ++i)
    chain += "    c" + std::to_string(i) + ": c" + std::to_string(i + 1) + "\n";
  CHECK(findings(chain).find("more than 1000 calculated tags") != std::string::npos);
}

TEST_CASE("units are checked where all that matter are given") {
  CHECK(findings("    heat: flow * (T_supply - {TI-102.PV})\n").empty());
  const std::string apart = findings("    heat: flow * (T_supply - flow) + {TI-102.PV} * flow\n");
  CHECK(apart.find("u.yaml:8:30: error: signals.calc.heat: subtracts kg/s from K\n") == 0);
  const std::string result = findings("    heat: flow / (T_supply - {TI-102.PV})\n");
  INFO(result);
  CHECK(result.find("u.yaml:8:11: error: signals.calc.heat: gives kg/(K s), and 'heat' is in K "
                    "kg/s") == 0);
  // By way of another, whose unit follows from its own expression.
  CHECK(findings("    heat: flow + rise\n    rise: \"T_supply - {TI-102.PV}\"\n")
            .find("adds K to kg/s") != std::string::npos);
  CHECK(findings("    heat: 4.19 * flow / (T_supply - {TI-102.PV})\n").empty());
  CHECK(findings("    heat: {expression: \"flow * (T_supply - {TI-102.PV})\", unit: kW}\n")
            .find("the signal 'heat' is given in K kg/s") != std::string::npos);
}

TEST_CASE("what nothing uses is told") {
  const std::string text = findings("    heta: flow * (T_supply - {TI-102.PV})\n");
  CHECK(text.find("u.yaml:8:5: warning: signals.calc.heta: no signal is called so") == 0);
  CHECK(findings("    heat: 4.19 * flow * T_supply\n").find("no expression uses 'TI-102.PV'") !=
        std::string::npos);
}

}  // namespace
}  // namespace mpm::config
