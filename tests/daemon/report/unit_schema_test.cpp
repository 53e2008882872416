#include "daemon/report/unit_schema.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "config/load_unit.hpp"

namespace mpm::report {
namespace {

using Json = nlohmann::ordered_json;

/// A unit file in which KEY stands where that part of the schema does.
struct Place {
  const char* part;  ///< of $defs; empty: the file itself
  std::string text;
};

const std::string kHead = "unit: t\nsample_time: 1\nsignals: {mv: [u], dv: [d], cv: [y]}\n";

std::vector<Place> places() {
  const std::string signals = "unit: t\nsample_time: 1\nsignals: ";
  const std::string channel = "model: {channels: [{cv: y, mv: u, gain: 1}], ";
  return {{"", "KEY:\n"},
          {"signals", signals + "{KEY: 1}\n"},
          {"model", kHead + "model: {KEY: }\n"},
          {"channel", kHead + "model: {channels: [{KEY: 1}]}\n"},
          {"tanks", kHead + "model: {channels: [{cv: y, mv: u, tanks: {KEY: 1}}]}\n"},
          {"state_space", kHead + "model: {state_space: {KEY: 1}}\n"},
          {"input_block", kHead + "model: {input: {u: {KEY: 1}}}\n"},
          {"output_block", kHead + "model: {output: {y: {KEY: 1}}}\n"},
          {"state_term", kHead + channel + "state: [{KEY: 1}]}\n"},
          {"disturbance", kHead + "model: {disturbances: [{shape: step, KEY: 1}]}\n"},
          {"monitor", kHead + "monitor: {KEY: 1}\n"},
          {"materiality", kHead + "monitor: {materiality: {KEY: 1}}\n"},
          {"channel_materiality", kHead + "monitor: {materiality: {channels: [{KEY: 1}]}}\n"},
          {"alarms", kHead + "alarms: {KEY: 1}\n"},
          {"controller_alarm", kHead + "alarms: {controller: {KEY: 1}}\n"},
          {"dds", kHead + "dds: {KEY: 1}\n"},
          {"simulation", kHead + "simulation: {KEY: 1}\n"},
          {"noise", kHead + "simulation: {noise: {y: {KEY: 1}}}\n"},
          {"setpoint", kHead + "simulation: {setpoints: {y: {KEY: 1}}}\n"},
          {"limits", kHead + "simulation: {limits: {u: {KEY: 1}}}\n"},
          {"identify", kHead + "identify: {KEY: }\n"}};
}

bool is_known(const Place& place, const std::string& key) {
  std::string text = place.text;
  text.replace(text.find("KEY"), 3, key);
  for (const config::Finding& finding :
       config::load_unit_text(text, "u.yaml", config::ModelNeed::kMayBeMissing).findings)
    if (finding.message.rfind("unknown ", 0) == 0) return false;
  return true;
}

TEST_CASE("every key of the schema is one that the loader reads") {
  const Json schema = unit_schema();
  for (const Place& place : places()) {
    const Json& part = *place.part == '\0' ? schema : schema["$defs"][place.part];
    CAPTURE(place.part);
    CHECK_FALSE(is_known(place, "nobody"));
    CHECK(part["additionalProperties"] == false);
    for (const auto& [key, value] : part["properties"].items()) {
      CAPTURE(key);
      CHECK(is_known(place, key));
    }
  }
}

TEST_CASE("kinds and ranges of settings are those of their declarations") {
  const Json parts = unit_schema()["$defs"];
  const Json& monitor = parts["monitor"]["properties"];
  CHECK(monitor["false_alarm_rate"]["exclusiveMinimum"] == 0.0);
  CHECK(monitor["false_alarm_rate"]["exclusiveMaximum"] == 1.0);
  CHECK(monitor["first_lag"]["type"] == "integer");
  CHECK(monitor["sliding_window"]["type"] == "boolean");
  CHECK(monitor["threshold"]["enum"] == Json::array({"f_test", "mean_line"}));
  CHECK(parts["disturbance"]["properties"]["shape"]["enum"] ==
        Json::array({"step", "drift", "periodic"}));
  CHECK(parts["alarms"]["properties"].contains("realarm"));
}

}  // namespace
}  // namespace mpm::report
