#include "daemon/report/unit_schema.hpp"

#include <cmath>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "config/choice.hpp"
#include "config/fields.hpp"

namespace mpm::report {
namespace {

using Json = nlohmann::ordered_json;

// All but the plain settings, which are added below. A text may look like a number; one value may
// stand for a list of one; a section may be empty.
constexpr const char* kSkeleton = R"json({
  "$schema": "https://json-schema.org/draft/2020-12/schema",
  "title": "Unit file of the MPM monitor",
  "description": "One MPC controller and its plant unit",
  "type": "object",
  "required": ["unit", "sample_time", "signals"],
  "additionalProperties": false,
  "properties": {
    "unit": {"$ref": "#/$defs/text", "description": "name, and key on the bus; without /"},
    "sample_time": {"$ref": "#/$defs/positive", "description": "s"},
    "signals": {"$ref": "#/$defs/signals"},
    "model": {"$ref": "#/$defs/model"},
    "operating_point": {"$ref": "#/$defs/number_by_tag",
      "description": "around which the model is linear"},
    "monitor": {"$ref": "#/$defs/monitor"},
    "alarms": {"$ref": "#/$defs/alarms"},
    "dds": {"$ref": "#/$defs/dds"},
    "simulation": {"$ref": "#/$defs/simulation"},
    "identify": {"$ref": "#/$defs/identify"}
  },
  "$defs": {
    "text": {"type": ["string", "number", "boolean"]},
    "positive": {"type": "number", "exclusiveMinimum": 0},
    "not_negative": {"type": "number", "minimum": 0},
    "moment": {"type": ["number", "string"], "description": "s, or ISO 8601 with a zone"},
    "numbers": {"anyOf": [{"type": "number"}, {"type": "array", "items": {"type": "number"}}]},
    "positives": {"anyOf": [{"$ref": "#/$defs/positive"},
      {"type": "array", "items": {"$ref": "#/$defs/positive"}}]},
    "pair": {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2},
    "matrix": {"anyOf": [{"type": "number"}, {"type": "array",
      "items": {"$ref": "#/$defs/numbers"}}]},
    "number_by_tag": {"type": ["object", "null"], "additionalProperties": {"type": "number"}},
    "weights": {"anyOf": [{"$ref": "#/$defs/not_negative"},
      {"type": "object", "additionalProperties": {"$ref": "#/$defs/not_negative"}}]},
    "limits": {"type": "object", "additionalProperties": false, "properties": {
      "low": {"type": "number"}, "high": {"type": "number"},
      "max_move": {"$ref": "#/$defs/positive", "description": "of an MV, a sample"}}},
    "signals": {"type": "object", "required": ["mv", "cv"], "additionalProperties": false,
      "properties": {
        "mv": {"$ref": "#/$defs/mvs", "description": "manipulated variables, in the controller's order"},
        "dv": {"$ref": "#/$defs/dvs", "description": "measured disturbances that the model uses"},
        "cv": {"$ref": "#/$defs/cvs", "description": "controlled variables"},
        "aux": {"$ref": "#/$defs/inputs", "description": "measured, in nobody's model yet"},
        "raw": {"$ref": "#/$defs/inputs", "description": "measured, to calculate others from"},
        "calc": {"type": ["object", "null"], "description": "tag: expression",
          "additionalProperties": {"anyOf": [{"$ref": "#/$defs/text"},
            {"type": "object", "required": ["expression"], "additionalProperties": false,
             "properties": {"expression": {"$ref": "#/$defs/text"}, "unit": {"$ref": "#/$defs/text"}}}]}}}},
    "inputs": {"anyOf": [{"type": "null"}, {"$ref": "#/$defs/input_signal"},
      {"type": "array", "items": {"$ref": "#/$defs/input_signal"}}]},
    "dvs": {"anyOf": [{"type": "null"}, {"$ref": "#/$defs/limited_signal"},
      {"type": "array", "items": {"$ref": "#/$defs/limited_signal"}}]},
    "mvs": {"anyOf": [{"$ref": "#/$defs/limited_signal"},
      {"type": "array", "minItems": 1, "items": {"$ref": "#/$defs/limited_signal"}}]},
    "cvs": {"anyOf": [{"$ref": "#/$defs/cv_signal"},
      {"type": "array", "minItems": 1, "items": {"$ref": "#/$defs/cv_signal"}}]},
    "input_signal": {"anyOf": [{"$ref": "#/$defs/text"}, {"type": "object", "required": ["tag"],
      "additionalProperties": false, "properties": {"tag": {"$ref": "#/$defs/text"},
      "unit": {"$ref": "#/$defs/text"}, "description": {"$ref": "#/$defs/text"}}}]},
    "limited_signal": {"anyOf": [{"$ref": "#/$defs/text"}, {"type": "object", "required": ["tag"],
      "additionalProperties": false, "properties": {"tag": {"$ref": "#/$defs/text"},
      "unit": {"$ref": "#/$defs/text"}, "description": {"$ref": "#/$defs/text"},
      "low": {"type": "number"}, "high": {"type": "number"}}}]},
    "cv_signal": {"anyOf": [{"$ref": "#/$defs/text"}, {"type": "object", "required": ["tag"],
      "additionalProperties": false, "properties": {"tag": {"$ref": "#/$defs/text"},
      "unit": {"$ref": "#/$defs/text"}, "description": {"$ref": "#/$defs/text"},
      "prediction": {"$ref": "#/$defs/text", "description": "tag of the controller's prediction"},
      "setpoint": {"$ref": "#/$defs/text", "description": "tag"},
      "low": {"type": "number"}, "high": {"type": "number"}}}]},
    "model": {"type": ["object", "null"], "additionalProperties": false, "properties": {
      "channels": {"type": ["array", "null"], "items": {"$ref": "#/$defs/channel"}},
      "state_space": {"$ref": "#/$defs/state_space"},
      "input": {"type": "object", "description": "by MV or DV, before the linear part",
        "additionalProperties": {"$ref": "#/$defs/input_block"}},
      "output": {"type": "object", "description": "by CV, behind the linear part",
        "additionalProperties": {"$ref": "#/$defs/output_block"}},
      "state": {"type": ["array", "null"], "items": {"$ref": "#/$defs/state_term"}},
      "disturbances": {"type": ["array", "null"], "items": {"$ref": "#/$defs/disturbance"}},
      "operating_point": {"$ref": "#/$defs/number_by_tag"}}},
    "channel": {"type": "object", "required": ["cv"], "additionalProperties": false,
      "anyOf": [{"required": ["gain"]}, {"required": ["numerator"]},
        {"required": ["step_response"]}, {"required": ["tanks"]}],
      "oneOf": [{"required": ["mv"]}, {"required": ["dv"]}],
      "properties": {
        "cv": {"$ref": "#/$defs/text"}, "mv": {"$ref": "#/$defs/text"},
        "dv": {"$ref": "#/$defs/text"},
        "gain": {"type": "number", "description": "CV units per MV unit; of an integrator per s"},
        "time_constants": {"$ref": "#/$defs/positives", "description": "s"},
        "lead": {"type": "number", "description": "s"},
        "dead_time": {"$ref": "#/$defs/not_negative", "description": "s"},
        "integrating": {"type": "boolean"},
        "numerator": {"$ref": "#/$defs/numbers",
          "description": "in z^-1; the first meets the input of one sample before"},
        "denominator": {"$ref": "#/$defs/numbers"},
        "delay_samples": {"type": "integer", "minimum": 0},
        "step_response": {"$ref": "#/$defs/numbers",
          "description": "per sample, holds its last value"},
        "tanks": {"$ref": "#/$defs/tanks"},
        "input": {"$ref": "#/$defs/input_block"}}},
    "tanks": {"type": "object", "additionalProperties": false,
      "required": ["time_constants", "empty_input", "empty_output"], "properties": {
        "time_constants": {"$ref": "#/$defs/positives", "description": "s, of each"},
        "empty_input": {"type": "number"}, "empty_output": {"type": "number"},
        "overflow": {"anyOf": [{"$ref": "#/$defs/overflow"},
          {"type": "array", "items": {"$ref": "#/$defs/overflow"}}]},
        "spill": {"type": "number", "minimum": 0, "maximum": 1},
        "dead_time": {"$ref": "#/$defs/not_negative", "description": "s"}}},
    "overflow": {"anyOf": [{"const": ".inf"}, {"type": "number", "exclusiveMinimum": 1}],
      "description": "of the level at the operating point; .inf = never"},
    "state_space": {"type": "object", "description": "discrete, with sample_time",
      "additionalProperties": false, "required": ["A", "B", "C"], "properties": {
        "A": {"$ref": "#/$defs/matrix"}, "B": {"$ref": "#/$defs/matrix"},
        "C": {"$ref": "#/$defs/matrix"}, "D": {"$ref": "#/$defs/matrix"},
        "x0": {"$ref": "#/$defs/numbers"}}},
    "input_block": {"type": "object", "additionalProperties": false, "maxProperties": 1,
      "properties": {
        "polynomial": {"$ref": "#/$defs/numbers", "description": "c1, c2 ..."},
        "saturation": {"$ref": "#/$defs/pair", "description": "low, high"},
        "deadband": {"$ref": "#/$defs/not_negative"},
        "stiction": {"type": "object", "required": ["band", "jump"], "additionalProperties": false,
          "properties": {"band": {"$ref": "#/$defs/not_negative"},
            "jump": {"$ref": "#/$defs/not_negative"}, "slips_once": {"type": "boolean"}}},
        "stuck": {"anyOf": [{"type": "number"}, {"type": "object", "required": ["value"],
          "additionalProperties": false, "properties": {"value": {"type": "number"},
          "onset": {"$ref": "#/$defs/moment"}}}]},
        "offset": {"anyOf": [{"type": "number"}, {"type": "object", "required": ["size"],
          "additionalProperties": false, "properties": {"size": {"type": "number"},
          "onset": {"$ref": "#/$defs/moment"}}}]},
        "product": {"type": "object", "required": ["of", "per_unit"], "additionalProperties": false,
          "properties": {"of": {"$ref": "#/$defs/text", "description": "tag of the other input"},
            "per_unit": {"type": "number"}, "linear": {"type": "number"}}},
        "two_sided": {"type": "object", "minProperties": 1, "additionalProperties": false,
          "anyOf": [{"required": ["above"]}, {"required": ["below"]}],
          "properties": {"above": {"type": "number", "description": "times, beyond `at`"},
            "below": {"type": "number"},
            "at": {"type": "number", "description": "the operating point unless given"}}}}},
    "output_block": {"type": "object", "additionalProperties": false, "maxProperties": 1,
      "properties": {"saturation": {"$ref": "#/$defs/pair", "description": "low, high"},
        "offset": {"type": "number"}, "scale": {"type": "number", "not": {"const": 0}}}},
    "state_term": {"type": "object", "required": ["cv"], "additionalProperties": false,
      "oneOf": [{"required": ["mv"]}, {"required": ["dv"]}],
      "properties": {
        "cv": {"$ref": "#/$defs/text"}, "mv": {"$ref": "#/$defs/text"},
        "dv": {"$ref": "#/$defs/text"},
        "restoring_force": {"type": "object", "minProperties": 1, "additionalProperties": false,
          "properties": {"quadratic": {"type": "number"}, "cubic": {"type": "number"}}},
        "square_root_outflow": {"type": "object", "required": ["empty_output"],
          "additionalProperties": false, "properties": {"empty_output": {"type": "number"}}},
        "coulomb_friction": {"type": "object", "required": ["force", "speed"],
          "additionalProperties": false, "properties": {"force": {"$ref": "#/$defs/not_negative"},
            "speed": {"$ref": "#/$defs/positive"}}}}},
    "disturbance": {"type": "object", "required": ["cv", "shape", "size"],
      "additionalProperties": false, "properties": {
        "cv": {"$ref": "#/$defs/text"}, "shape": {},
        "onset": {"$ref": "#/$defs/moment"}, "size": {"type": "number"},
        "time_constant": {"$ref": "#/$defs/not_negative", "description": "s"},
        "decay": {"$ref": "#/$defs/positive", "description": "s, with which it passes"},
        "period": {"$ref": "#/$defs/positive", "description": "s"},
        "wave": {"enum": ["sine", "square"]}, "until": {"$ref": "#/$defs/moment"}}},
    "channel_materiality": {"type": "object", "required": ["cv", "mv"],
      "additionalProperties": false,
      "properties": {"cv": {"$ref": "#/$defs/text"}, "mv": {"$ref": "#/$defs/text"}}},
    "materiality": {"type": ["object", "null"], "additionalProperties": false, "properties": {
      "channels": {"type": ["array", "null"], "items": {"$ref": "#/$defs/channel_materiality"}}}},
    "monitor": {"type": ["object", "null"], "additionalProperties": false, "properties": {
      "materiality": {"$ref": "#/$defs/materiality",
        "description": "errors that matter to the controller"}}},
    "controller_alarm": {"type": ["object", "null"], "additionalProperties": false, "properties": {},
      "if": {"required": ["class"], "properties": {"class": {"const": "alarm"}}},
      "then": {"required": ["consequence", "action", "time_to_respond"]}},
    "alarms": {"type": ["object", "null"], "additionalProperties": false, "properties": {
      "controller": {"$ref": "#/$defs/controller_alarm"}}},
    "dds": {"type": ["object", "null"], "additionalProperties": false, "properties": {
      "peers": {"description": "hosts to ask for, where there is no multicast",
        "anyOf": [{"type": "null"}, {"$ref": "#/$defs/text"},
        {"type": "array", "items": {"$ref": "#/$defs/text"}}]}}},
    "noise": {"type": "object", "additionalProperties": false, "properties": {}},
    "setpoint": {"type": "object", "additionalProperties": false, "properties": {}},
    "noises": {"anyOf": [{"$ref": "#/$defs/noise"},
      {"type": "object", "additionalProperties": {"$ref": "#/$defs/noise"}}]},
    "setpoints": {"anyOf": [{"$ref": "#/$defs/setpoint"},
      {"type": "object", "additionalProperties": {"$ref": "#/$defs/setpoint"}}]},
    "simulation": {"type": ["object", "null"], "description": "for mpmsim alone",
      "additionalProperties": false, "properties": {
        "process": {"$ref": "#/$defs/text"},
        "move_blocks": {"anyOf": [{"type": "integer", "minimum": 1}, {"type": "array", "minItems": 1,
          "items": {"type": "integer", "minimum": 1}}]},
        "cv_weights": {"$ref": "#/$defs/weights"}, "move_weights": {"$ref": "#/$defs/weights"},
        "limits": {"type": "object", "additionalProperties": {"$ref": "#/$defs/limits"}},
        "noise": {"$ref": "#/$defs/noises"}, "dv_movement": {"$ref": "#/$defs/noises"},
        "aux_movement": {"$ref": "#/$defs/noises"}, "setpoints": {"$ref": "#/$defs/setpoints"}}},
    "identify": {"type": ["object", "null"], "additionalProperties": false, "properties": {
      "channels": {"type": ["array", "null"], "items": {"type": "object", "required": ["cv"],
        "additionalProperties": false, "oneOf": [{"required": ["mv"]}, {"required": ["dv"]}],
        "properties": {"cv": {"$ref": "#/$defs/text"}, "mv": {"$ref": "#/$defs/text"},
          "dv": {"$ref": "#/$defs/text"}, "sign": {"enum": ["+", "-"]},
          "relation": {"const": "none"}, "dead_time": {"$ref": "#/$defs/not_negative"},
          "integrating": {"type": "boolean"}}}}}}
  }
})json";

Json numbers_in(const config::Range& range, const char* type) {
  Json json{{"type", type}};
  if (std::isfinite(range.low)) json[range.low_open ? "exclusiveMinimum" : "minimum"] = range.low;
  if (std::isfinite(range.high))
    json[range.high_open ? "exclusiveMaximum" : "maximum"] = range.high;
  return json;
}

template <class Kind>
Json names_of() {
  Json names = Json::array();
  for (const auto& choice : config::choices(Kind{})) names.push_back(choice.name);
  return {{"enum", names}};
}

template <class Settings>
void add(Json& object, const std::vector<config::Field<Settings>>& fields) {
  for (const config::Field<Settings>& field : fields) {
    Json json = std::visit(
        [&]<class T>(T Settings::*) -> Json {
          if constexpr (std::is_same_v<T, double>) return numbers_in(field.range, "number");
          if constexpr (std::is_same_v<T, int>) return numbers_in(field.range, "integer");
          if constexpr (std::is_same_v<T, bool>) return {{"type", "boolean"}};
          if constexpr (std::is_same_v<T, std::string>) return {{"$ref", "#/$defs/text"}};
          if constexpr (std::is_enum_v<T>) return names_of<T>();
        },
        field.member);
    if (*field.notes != '\0') json["description"] = field.notes;
    object["properties"][field.key] = std::move(json);
  }
}

}  // namespace

Json unit_schema() {
  Json schema = Json::parse(kSkeleton);
  Json& parts = schema["$defs"];
  add(parts["monitor"], config::monitor_fields());
  add(parts["materiality"], config::materiality_fields());
  add(parts["channel_materiality"], config::materiality_fields());
  add(parts["alarms"], config::alarm_fields());
  add(parts["alarms"], config::managed_alarm_fields());
  add(parts["controller_alarm"], config::controller_alarm_fields());
  add(parts["dds"], config::bus_fields());
  add(parts["simulation"], config::simulation_fields());
  add(parts["noise"], config::noise_fields());
  add(parts["setpoint"], config::setpoint_fields());
  parts["disturbance"]["properties"]["shape"] = names_of<DisturbanceShape>();
  return schema;
}

}  // namespace mpm::report
