#include "daemon/http/server.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/daemon/http/connection.hpp"
#include "tests/daemon/http/sample_board.hpp"

namespace mpm::http::server_test {
namespace {

using namespace std::chrono_literals;
using Catch::Matchers::Contains;
using test::Connection;

struct Bench {
  Bench() : server(Address{}, sample.board, parts()) {
    sample.board.start();
    sample.show(true);
    server.start();
  }
  Api::Parts parts() {
    Api::Parts parts;
    parts.board = &sample.board;
    return parts;
  }
  [[nodiscard]] std::string ask(const std::string& line, const std::string& more = "",
                                const std::string& body = "") const {
    const Connection connection(server.address().port);
    connection.say(line + " HTTP/1.1\r\nHost: 127.0.0.1\r\n" + more + "\r\n" + body);
    return connection.hear();
  }
  [[nodiscard]] std::size_t streams() const {
    const std::string answer = ask("GET /api/v1/system");
    return Json::parse(answer.substr(answer.find("\r\n\r\n")))["server"]["streams"];
  }

  test::SampleBoard sample;
  Server server;
};

TEST_CASE("each answer says what a browser may do with it") {
  const Bench bench;
  CHECK(bench.server.address().port > 0);
  for (const char* line : {"GET /", "GET /page.js", "GET /api/v1/units", "GET /nothing",
                           "POST /api/v1/commands", "DELETE /"}) {
    CAPTURE(line);
    const std::string answer = bench.ask(line, "Content-Length: 0\r\n");
    CHECK_THAT(answer, Contains("Content-Security-Policy: default-src 'none'; script-src 'self'"));
    CHECK_THAT(answer, Contains("X-Content-Type-Options: nosniff"));
    CHECK_THAT(answer, Contains("Referrer-Policy: no-referrer"));
    CHECK(answer.find("unsafe-") == std::string::npos);
  }
}

TEST_CASE("a file that a browser has is not sent again") {
  const Bench bench;
  const std::string first = bench.ask("GET /page.css");
  const std::size_t at = first.find("ETag: ") + 6;
  const std::string tag = first.substr(at, first.find('\r', at) - at);
  CHECK_THAT(bench.ask("GET /page.css", "If-None-Match: " + tag + "\r\n"),
             Contains("HTTP/1.1 304"));
  CHECK_THAT(bench.ask("GET /page.css", "If-None-Match: \"x\"\r\n"), Contains("HTTP/1.1 200"));
  CHECK_THAT(bench.ask("HEAD /"), Contains("Content-Length: "));
}

// Beyond its end lies the memory of others.
TEST_CASE("whatever part is asked for, the whole answer comes") {
  const Bench bench;
  for (const char* line : {"GET /page.css", "GET /nothing", "GET /api/v1/units"}) {
    const std::string whole = bench.ask(line);
    const std::string body = whole.substr(whole.find("\r\n\r\n"));
    for (const char* range : {"0-5", "3-", "-7", "100000-200000", "0-99999999", "99999999-",
                              "0-1,5-9", "1-0", "0-5,7-4", "0-5,99999999-1"}) {
      CAPTURE(line, range);
      const std::string answer = bench.ask(line, "Range: bytes=" + std::string(range) + "\r\n");
      CHECK(answer.find("multipart") == std::string::npos);
      if (answer.starts_with("HTTP/1.1 416")) {
        CHECK(Json::accept(answer.substr(answer.find("\r\n\r\n") + 4)));
        continue;
      }
      CHECK(answer.substr(0, 12) == whole.substr(0, 12));
      CHECK(answer.substr(answer.find("\r\n\r\n")) == body);
    }
  }
}

TEST_CASE("a name that is not ours is refused before anything is told") {
  const Bench bench;
  const Connection connection(bench.server.address().port);
  connection.say("GET /api/v1/events HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  const std::string answer = connection.hear();
  CHECK_THAT(answer, Contains("HTTP/1.1 421"));
  CHECK(answer.find("column") == std::string::npos);
}

TEST_CASE("large and broken requests are refused") {
  const Bench bench;
  CHECK_THAT(bench.ask("POST /api/v1/commands", "Content-Length: 1000000\r\n",
                       std::string(1'000'000, 'x')),
             Contains("HTTP/1.1 413"));
  CHECK_THAT(bench.ask("GET /" + std::string(9'000, 'x')), Contains("HTTP/1.1 414"));
  const Connection connection(bench.server.address().port);
  connection.say("nonsense\r\n\r\n");
  CHECK_THAT(connection.hear(), Contains("HTTP/1.1 400"));
}

TEST_CASE(
    "what is refused unseen is refused with an error in JSON, and as a browser is to take it") {
  const Bench bench;
  const auto error = [&](const std::string& line, const std::string& more,
                         const std::string& body) {
    const std::string answer = bench.ask(line, more, body);
    CHECK_THAT(answer, Contains("X-Content-Type-Options: nosniff"));
    const std::size_t at = answer.find("\r\n\r\n");
    REQUIRE(at != std::string::npos);
    CHECK(Json::parse(answer.substr(at))["error"].is_string());
    return answer.substr(9, 3);
  };
  CHECK(error("GET /", "X: " + std::string(20'000, 'a') + "\r\n", "") == "431");
  CHECK(error("POST /api/v1/commands", "Content-Length: 20000\r\n", "") == "413");
  CHECK(error("POST /api/v1/commands", "Content-Length: x\r\n", "") == "400");
  CHECK(error("POST /api/v1/commands", "Transfer-Encoding: chunked\r\n", "0\r\n\r\n") == "411");
  // A body of no length is none: it is not waited for.
  CHECK(error("POST /api/v1/commands", "", "") == "403");
  CHECK(error("BREW /", "", "") == "400");
}

TEST_CASE("headers without end are refused, on however many connections") {
  const Bench bench;
  std::vector<Connection> open;
  for (int k = 0; k < 100; ++k) {
    open.emplace_back(bench.server.address().port);
    open.back().say("GET / HTTP/1.1\r\nHost: localhost\r\n");
  }
  std::string line;
  for (int k = 0; k < 1000; ++k) line += "X" + std::to_string(k) + ": aaaaaaaaaaaa\r\n";
  for (const Connection& each : open) each.say(line);
  for (const Connection& each : open) CHECK_THAT(each.hear("}"), Contains("HTTP/1.1 431"));
  CHECK_THAT(bench.ask("GET /healthz"), Contains("HTTP/1.1 200"));
}

TEST_CASE("who has not said all he asks holds up nobody") {
  const Bench bench;
  std::vector<Connection> open;
  for (int k = 0; k < 300; ++k) {  // more than there are threads, and more than wait in all
    open.emplace_back(bench.server.address().port);
    open.back().say(k % 2 == 0 ? "GET / HTTP/1.1\r\nHost: loc"
                               : "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n");
  }
  CHECK_THAT(bench.ask("GET /healthz"), Contains("HTTP/1.1 200"));
  CHECK_THAT(open.back().hear("}"), Contains("HTTP/1.1 408"));
}

TEST_CASE("streams are told of news, are counted, and there is a most of them") {
  Bench bench;
  std::vector<Connection> open;
  for (std::size_t k = 0; k < Server::kMostStreams; ++k) {
    open.emplace_back(bench.server.address().port);
    open.back().say("GET /api/v1/events HTTP/1.1\r\nHost: localhost\r\n\r\n");
    CHECK_THAT(open.back().hear("event: state"), Contains("text/event-stream"));
  }
  CHECK_THAT(bench.ask("GET /api/v1/events"), Contains("HTTP/1.1 503"));
  CHECK(bench.streams() == Server::kMostStreams);
  CHECK_THAT(bench.ask("GET /api/v1/units"), Contains("HTTP/1.1 200"));  // others are served
  bench.sample.show(false);
  CHECK_THAT(open.front().hear("-2\n"), Contains("event: state"));
  // Who leaves makes room.
  open.clear();
  bool room = false;
  for (int waits = 0; waits < 100 && !room; ++waits) {
    std::this_thread::sleep_for(100ms);
    room = bench.streams() == 0;
  }
  CHECK(room);
}

TEST_CASE("a server ends with streams open") {
  auto bench = std::make_unique<Bench>();
  const Connection connection(bench->server.address().port);
  connection.say("GET /api/v1/events HTTP/1.1\r\nHost: localhost\r\n\r\n");
  (void)connection.hear("event: state");
  const auto before = std::chrono::steady_clock::now();
  bench.reset();
  CHECK(std::chrono::steady_clock::now() - before < 5s);
}

TEST_CASE("a port that is taken is not shared") {
  const Bench bench;
  test::SampleBoard other;
  Api::Parts parts;
  parts.board = &other.board;
  CHECK_THROWS_WITH(Server(bench.server.address(), other.board, std::move(parts)),
                    Contains("the port is taken") && !Contains("none of this machine"));
}

}  // namespace
}  // namespace mpm::http::server_test
