// daemon/http/openapi.json says what the API really answers: every answer fits its schema, and
// names nothing that the schema does not.
#include <catch2/catch.hpp>
#include <string>

#include "core/alarm/alarm_command.hpp"
#include "core/alarm/calibration.hpp"
#include "daemon/http/api.hpp"
#include "daemon/http/assets.hpp"
#include "tests/daemon/http/sample_board.hpp"

namespace mpm::http::openapi_test {
namespace {

const Json& openapi() {
  static const Json document = Json::parse(find_asset("/api/v1/openapi.json")->bytes);
  return document;
}

bool is_type(const Json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "integer") return value.is_number_integer();
  if (type == "number") return value.is_number();
  return type == "null" && value.is_null();
}

bool has_type(const Json& value, const Json& types) {
  if (types.is_string()) return is_type(value, types.get<std::string>());
  return std::any_of(types.begin(), types.end(), [&value](const Json& type) {
    return is_type(value, type.get<std::string>());
  });
}

/// What of JSON Schema the file uses.
void fits(const Json& value, const Json& schema, const std::string& place) {
  INFO(place);
  if (schema.contains("$ref")) {
    const auto name = schema["$ref"].get<std::string>();
    return fits(value, openapi().at(Json::json_pointer(name.substr(1))), place);
  }
  if (schema.contains("type")) {
    CHECK(has_type(value, schema["type"]));
    if (!has_type(value, schema["type"])) return;
  }
  if (schema.contains("enum"))
    CHECK(std::find(schema["enum"].begin(), schema["enum"].end(), value) != schema["enum"].end());
  if (value.is_array() && schema.contains("items"))
    for (const Json& item : value) fits(item, schema["items"], place + "[]");
  if (!value.is_object()) return;
  for (const Json& name : schema.value("required", Json::array()))
    CHECK(value.contains(name.get<std::string>()));
  const Json properties = schema.value("properties", Json::object());
  for (const auto& [name, member] : value.items()) {
    if (properties.contains(name))
      fits(member, properties[name], place + "." + name);
    else if (schema.contains("additionalProperties"))
      FAIL_CHECK(place << "." << name << " is not in the schema");
  }
}

const Json& schema_of(const std::string& path, const std::string& method,
                      const std::string& status) {
  const Json& responses = openapi()["paths"].at(path).at(method)["responses"];
  const Json& response = responses.contains(status) ? responses[status] : responses["default"];
  return response["content"]["application/json"]["schema"];
}

struct Bench {
  Bench() {
    sample.push(30);
    sample.troubles = {{"x", bus::Severity::kFailure, "no data"}};
    sample.show(true);
    live::DiagnosisOutcome outcome;
    outcome.causes.resize(6);
    outcome.causes[0].cause = "gain";
    sample.feed().on_diagnosis(outcome);
    sample.fetch();
  }
  [[nodiscard]] Api api() const {
    Api::Parts parts;
    parts.board = &sample.board;
    parts.guard = Guard({}, host::CommandToken("0123456789abcdef"));
    parts.command = [](const AlarmCommand& command) { return CommandReply{command.once, "words"}; };
    return Api(std::move(parts));
  }
  test::SampleBoard sample;
};

TEST_CASE("each answer is as the OpenAPI file says") {
  const Bench bench;
  const Api api = bench.api();
  for (const auto& [path, target] : std::vector<std::pair<std::string, std::string>>{
           {"/api/v1/units", "/api/v1/units"},
           {"/api/v1/units/{unit}", "/api/v1/units/column"},
           {"/api/v1/units/{unit}/alarms", "/api/v1/units/column/alarms"},
           {"/api/v1/units/{unit}/cvs/{cv}/series", "/api/v1/units/column/cvs/AI-201/series"},
           {"/api/v1/units/{unit}/cvs/{cv}/correlations",
            "/api/v1/units/column/cvs/AI-201/correlations"},
           {"/api/v1/units/{unit}/diagnosis", "/api/v1/units/column/diagnosis"},
           {"/api/v1/journal", "/api/v1/journal"},
           {"/api/v1/system", "/api/v1/system"},
           {"/healthz", "/healthz"},
           {"/readyz", "/readyz"},
           {"/api/v1/units/{unit}", "/api/v1/units/nobody"}}) {
    CAPTURE(target);
    Request request;
    request.target = target;
    request.headers["host"] = "localhost";
    const Reply reply = api.answer(request);
    fits(Json::parse(reply.body), schema_of(path, "get", std::to_string(reply.status)), target);
  }
}

TEST_CASE("what has not begun is as the file says too") {
  const test::SampleBoard sample;
  Api::Parts parts;
  parts.board = &sample.board;
  const Api api(std::move(parts));
  for (const auto& [path, target] : std::vector<std::pair<std::string, std::string>>{
           {"/api/v1/units", "/api/v1/units"},
           {"/api/v1/units/{unit}", "/api/v1/units/column"},
           {"/api/v1/units/{unit}/cvs/{cv}/series", "/api/v1/units/column/cvs/AI-201/series"},
           {"/api/v1/units/{unit}/diagnosis", "/api/v1/units/column/diagnosis"},
           {"/api/v1/system", "/api/v1/system"},
           {"/readyz", "/readyz"}}) {
    Request request;
    request.target = target;
    request.headers["host"] = "localhost";
    const Reply reply = api.answer(request);
    fits(Json::parse(reply.body), schema_of(path, "get", std::to_string(reply.status)), target);
  }
}

TEST_CASE("a command and its answers are as the file says") {
  const Bench bench;
  const Api api = bench.api();
  const Json& schema = openapi()["components"]["schemas"]["Command"];
  const Json& words = schema["properties"]["command"]["enum"];
  CHECK(words.size() == words_of(AlarmAction{}).size());
  CHECK(schema["properties"]["duration_s"]["maximum"] == calibration::kMostShelf);
  for (const char* status : {"405", "408", "411", "413", "421", "431", "503"})
    CHECK(openapi()["paths"]["/api/v1/commands"]["post"]["responses"].contains(status));
  for (const bool once : {true, false})
    for (const Json& word : words) {
      const Json command = {{"unit", "column"}, {"mv", "FIC-101"}, {"cv", "AI-201"},
                            {"command", word},  {"once", once},    {"user", "ann"}};
      fits(command, schema, "command");
      Request request;
      request.method = "POST";
      request.target = "/api/v1/commands";
      request.headers = {{"host", "localhost"},
                         {"authorization", "Bearer 0123456789abcdef"},
                         {"content-type", "application/json"}};
      request.body = command.dump();
      const Reply reply = api.answer(request);
      CHECK(reply.status == (once ? 200 : 409));
      fits(Json::parse(reply.body),
           schema_of("/api/v1/commands", "post", std::to_string(reply.status)), "reply");
    }
}

TEST_CASE("a schema refuses what does not fit") {
  // Of the check itself: an answer without a number, or with one more.
  const Json& schema = openapi()["components"]["schemas"]["Limits"];
  CHECK(schema["additionalProperties"] == false);
  CHECK(schema["required"].size() == 2);
  CHECK_FALSE(has_type(Json("x"), schema["properties"]["low"]["type"]));
}

}  // namespace
}  // namespace mpm::http::openapi_test
