#include "daemon/http/target.hpp"

#include <catch2/catch.hpp>

namespace mpm::http {
namespace {

using Path = std::vector<std::string>;

TEST_CASE("a path is split before it is decoded") {
  CHECK(parse_target("/")->path.empty());
  CHECK(parse_target("/api/v1/units/a%2Fb%20c/alarms")->path ==
        Path{"api", "v1", "units", "a/b c", "alarms"});
  CHECK(parse_target("/units/../x")->path == Path{"units", "..", "x"});  // names nothing
}

TEST_CASE("a query is decoded") {
  const auto target = parse_target("/x?from=1.5&cv=T%26P+1&flag#end");
  REQUIRE(target);
  CHECK(target->query.at("from") == "1.5");
  CHECK(target->query.at("cv") == "T&P 1");
  CHECK(target->query.at("flag").empty());
}

TEST_CASE("what is no target is none") {
  for (const char* text : {"", "x", "*", "/%", "/%4", "/%zz", "/x?a=%"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_target(text));
  }
}

}  // namespace
}  // namespace mpm::http
