#include "daemon/http/api.hpp"

#include <catch2/catch.hpp>

#include "tests/daemon/http/sample_board.hpp"

namespace mpm::http::api_test {
namespace {

const std::string kToken = "0123456789abcdef";
const std::string kCommand =
    R"({"unit":"column","mv":"FIC-101","cv":"AI-201","command":"acknowledge","user":"ann"})";

Request get(const std::string& target) {
  Request request;
  request.target = target;
  request.headers["host"] = "127.0.0.1:8080";
  return request;
}

Request post(const std::string& body) {
  Request request = get("/api/v1/commands");
  request.method = "POST";
  request.body = body;
  request.peer = "10.0.0.7";
  request.headers["authorization"] = "Bearer " + kToken;
  request.headers["content-type"] = "application/json";
  return request;
}

struct Bench {
  explicit Bench(const std::string& token = kToken) : api(parts(token)) { sample.show(true); }

  Api::Parts parts(const std::string& token) {
    Api::Parts parts;
    parts.board = &sample.board;
    if (!token.empty()) parts.guard = Guard({}, host::CommandToken(token));
    parts.version = "mpmd test";
    parts.command = [this](const AlarmCommand& command) {
      given.push_back(command);
      return CommandReply{command.comment.empty(), "done"};
    };
    parts.refused = [this](const AlarmCommand& command, const std::string& why) {
      refused.emplace_back(command, why);
    };
    return parts;
  }
  [[nodiscard]] int status(const Request& request) const { return api.answer(request).status; }

  test::SampleBoard sample;
  std::vector<AlarmCommand> given;
  std::vector<std::pair<AlarmCommand, std::string>> refused;
  Api api;
};

TEST_CASE("each resource answers with JSON") {
  Bench bench;
  bench.sample.push(10);
  for (const char* target : {"/healthz", "/readyz", "/api/v1/units", "/api/v1/units/column",
                             "/api/v1/units/column/alarms", "/api/v1/units/column/diagnosis",
                             "/api/v1/units/column/cvs/AI-201/series?points=50&from=1&until=2",
                             "/api/v1/units/column/cvs/AI%2D201/correlations",
                             "/api/v1/journal?since=0&unit=column", "/api/v1/system"}) {
    CAPTURE(target);
    const Reply reply = bench.api.answer(get(target));
    CHECK(reply.status == 200);
    CHECK(reply.type == "application/json; charset=utf-8");
    CHECK(Json::parse(reply.body).is_object());
  }
}

TEST_CASE("what is not there is said not to be") {
  const Bench bench;
  for (const char* target :
       {"/nothing", "/api", "/api/v1", "/api/v1/x", "/api/v1/units/nobody",
        "/api/v1/units/column/x", "/api/v1/units/column/cvs/AI-201",
        "/api/v1/units/column/cvs/none/series", "/api/v1/units/column/cvs/AI-201/x",
        "/reports/column/20240501T120000Z/report.html", "/reports/x", "/../../etc/passwd"}) {
    CAPTURE(target);
    CHECK(bench.status(get(target)) == 404);
  }
  for (const char* target : {"/api/v1/units/column/cvs/AI-201/series?from=x",
                             "/api/v1/units/column/cvs/AI-201/series?points=1e",
                             "/api/v1/journal?since=nan", "/api/v1/journal?most=0", "/%"}) {
    CAPTURE(target);
    CHECK(bench.status(get(target)) == 400);
  }
}

TEST_CASE("a question that cannot be meant is refused, and told what is wrong with it") {
  const Bench bench;
  const std::string series = "/api/v1/units/column/cvs/AI-201/series?";
  const auto error = [&bench](const std::string& target) {
    const Reply reply = bench.api.answer(get(target));
    CHECK(reply.status == 400);
    return Json::parse(reply.body).value("error", "");
  };
  for (const char* points : {"points=9", "points=2001", "points=-1", "points=99999"})
    CHECK(error(series + points) == "points is to be from 10 to 2000");
  CHECK(bench.status(get(series + "points=10")) == 200);
  CHECK(bench.status(get(series + "points=2000")) == 200);
  CHECK(error(series + "span=-1") == "span is to be more than 0 s");
  CHECK(error(series + "span=0") == "span is to be more than 0 s");
  CHECK(error(series + "from=2&until=1") == "from is to be before until");
  for (const char* most : {"abc", "0", "-1", "5001", "1.5"})
    CHECK(error("/api/v1/journal?most=" + std::string(most)) ==
          "most is to be a whole number from 1 to 5000");
  CHECK(error("/api/v1/journal?since=x") == "since and until are seconds since 1970");
  CHECK(error("/api/v1/journal?since=2&until=1") == "since is to be before until");
}

TEST_CASE("who asks in the wrong way is told the right one") {
  const Bench bench;
  const auto allowed = [&bench](const std::string& method, const std::string& target) {
    Request request = get(target);
    request.method = method;
    const Reply reply = bench.api.answer(request);
    CHECK(reply.status == 405);
    return reply.headers.at("Allow");
  };
  CHECK(allowed("GET", "/api/v1/commands") == "POST");
  CHECK(allowed("POST", "/api/v1/units") == "GET, HEAD");
  CHECK(allowed("DELETE", "/api/v1/units") == "GET, HEAD, POST");
}

TEST_CASE("who is not meant does not answer") {
  const Bench bench;
  Request request = get("/api/v1/units");
  request.headers["host"] = "evil.example";
  CHECK(bench.status(request) == 421);
  request.headers.clear();
  CHECK(bench.status(request) == 421);
}

TEST_CASE("a command is handed over with where it comes from") {
  Bench bench;
  const Reply reply = bench.api.answer(post(kCommand));
  CHECK(reply.status == 200);
  CHECK(Json::parse(reply.body)["accepted"] == true);
  REQUIRE(bench.given.size() == 1);
  CHECK(bench.given[0].host == "10.0.0.7");
  CHECK(bench.given[0].action == AlarmAction::kAcknowledge);
  // What the monitor refuses is a conflict, in its own words.
  const std::string refused = R"({"unit":"column","command":"shelve","user":"a","comment":"no"})";
  CHECK(bench.status(post(refused)) == 409);
}

TEST_CASE("commands without the token, of other pages or in other forms are refused") {
  Bench bench;
  Request request = post(kCommand);
  request.headers["authorization"] = "Bearer wrong";
  CHECK(bench.status(request) == 401);
  // That somebody tried is to be kept, where it is known what he tried.
  REQUIRE(bench.refused.size() == 1);
  CHECK(bench.refused[0].first.host == "10.0.0.7");
  CHECK(bench.refused[0].second == "the token is missing or wrong");
  request.headers.erase("authorization");
  CHECK(bench.status(request) == 401);
  request = post(kCommand);
  request.headers["origin"] = "http://evil.example";
  CHECK(bench.status(request) == 403);
  request = post(kCommand);
  request.headers["sec-fetch-site"] = "cross-site";
  CHECK(bench.status(request) == 403);
  request = post(kCommand);
  request.headers["content-type"] = "text/plain";
  CHECK(bench.status(request) == 415);
  CHECK(bench.status(post("{}")) == 400);
  CHECK(bench.status(post(R"({"unit":"x","command":"acknowledge","user":"a"})")) == 404);
  request = post(kCommand);
  request.target = "/api/v1/units";
  CHECK(bench.status(request) == 405);
  request.method = "DELETE";
  CHECK(bench.status(request) == 405);
  CHECK(bench.given.empty());
}

TEST_CASE("without a token nobody may command, and is told why") {
  Bench bench("");
  Request request = post(kCommand);
  request.headers["authorization"] = "Bearer ";
  const Reply reply = bench.api.answer(request);
  CHECK(reply.status == 403);
  CHECK(reply.body.find("--token-file") != std::string::npos);
  CHECK(bench.given.empty());
}

TEST_CASE("the monitor is ready when it has seen all units") {
  const test::SampleBoard sample;
  Api::Parts parts;
  parts.board = &sample.board;
  const Api api(std::move(parts));
  CHECK(api.answer(get("/readyz")).status == 503);
  CHECK(api.answer(get("/healthz")).status == 200);
}

TEST_CASE("the journal is chosen from") {
  Bench bench;
  const auto events = [&](const std::string& query) {
    return Json::parse(bench.api.answer(get("/api/v1/journal" + query)).body)["events"].size();
  };
  CHECK(events("") == 1);
  CHECK(events("?since=7&until=7") == 1);
  CHECK(events("?since=7.5") == 0);
  CHECK(events("?unit=other") == 0);
  CHECK(events("?cv=AI-201") == 1);
}

}  // namespace
}  // namespace mpm::http::api_test
