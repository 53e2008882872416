#include "daemon/http/command_json.hpp"

#include <catch2/catch.hpp>

namespace mpm::http {
namespace {

std::string problem_of(const std::string& body) {
  const auto parsed = parse_command(body);
  const auto* problem = std::get_if<std::string>(&parsed);
  return problem == nullptr ? "" : *problem;
}

TEST_CASE("a command is read from its JSON") {
  const auto parsed = parse_command(
      R"({"unit":"shell","mv":"u3","cv":"y3","command":"shelve","duration_s":3600,"once":true,)"
      R"("user":"ann","comment":"valve\nis being changed"})");
  const auto* command = std::get_if<AlarmCommand>(&parsed);
  REQUIRE(command != nullptr);
  CHECK(command->unit == "shell");
  CHECK(command->action == AlarmAction::kShelve);
  CHECK(command->duration_s == 3600.0);
  CHECK(command->once);
  CHECK(command->user == "ann");
  CHECK(command->comment == "valve\\nis being changed");  // one line wherever it goes
}

TEST_CASE("the alarm of a unit has neither MV nor CV") {
  CHECK(problem_of(R"({"unit":"u","command":"acknowledge","user":"ann"})").empty());
  CHECK_FALSE(problem_of(R"({"unit":"u","cv":"y","command":"acknowledge","user":"a"})").empty());
}

TEST_CASE("what is wrong is said") {
  for (const char* body :
       {"", "[]", "{", R"({"unit":"u","command":"acknowledge"})",
        R"({"command":"acknowledge","user":"a"})", R"({"unit":"u","command":"reset","user":"a"})",
        R"({"unit":"u","command":"shelve","user":"a","duration_s":-1})",
        R"({"unit":"u","command":"shelve","user":"a","duration_s":1e9})",
        R"({"unit":"u","command":"shelve","user":"a","duration_s":"1"})",
        R"({"unit":"u","command":"shelve","user":"a","once":1})",
        R"({"unit":1,"command":"shelve","user":"a"})",
        R"({"unit":"u","command":"shelve","user":"a","colour":"red"})"}) {
    CAPTURE(body);
    CHECK_FALSE(problem_of(body).empty());
  }
  CHECK(problem_of(R"({"unit":"u","command":"shelve","user":"a","comment":")" +
                   std::string(2000, 'x') + "\"}") == "comment is longer than 1000 bytes");
}

}  // namespace
}  // namespace mpm::http
