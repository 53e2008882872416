#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/system/process.hpp"

namespace mpm::test {
namespace {

TEST_CASE("mpm schema prints a schema, the same each time") {
  const TemporaryFolder folder;
  REQUIRE(run({"mpm", "schema"}, folder.file("first"), folder.file("err")) == 0);
  REQUIRE(run({"mpm", "schema"}, folder.file("second"), folder.file("err")) == 0);
  CHECK(read_file(folder.file("first")) == read_file(folder.file("second")));
  const auto schema = nlohmann::json::parse(read_file(folder.file("first")));
  CHECK(schema["$schema"] == "https://json-schema.org/draft/2020-12/schema");
  CHECK(schema["required"] == nlohmann::json::array({"unit", "sample_time", "signals"}));
}

}  // namespace
}  // namespace mpm::test
