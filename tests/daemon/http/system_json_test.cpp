#include "daemon/http/system_json.hpp"

#include <catch2/catch.hpp>

#include "tests/daemon/http/sample_board.hpp"

namespace mpm::http {
namespace {

TEST_CASE("the monitor tells of itself and of each unit's health") {
  test::SampleBoard sample;
  sample.troubles = {{"x", bus::Severity::kOutOfSpecification, "AI-201 has no value"}};
  sample.push(20);
  sample.show(true);
  const Json json = system_json(sample.board, "mpmd 1.2.3", 5);
  CHECK(json["version"] == "mpmd 1.2.3");
  CHECK(json["started_ns"] == 5);
  CHECK(json["resident_bytes"] > 1'000'000);
  CHECK(json["processor_seconds"] > 0.0);
  REQUIRE(json["units"].size() == 1);
  CHECK(json["units"][0]["unit"] == "column");
  CHECK(json["units"][0]["state"] == "maintenance_required");
  CHECK(json["units"][0]["troubles"][0]["severity"] == "out_of_specification");
  CHECK(json["units"][0]["troubles"][0]["text"] == "AI-201 has no value");
  CHECK(json["units"][0]["page_history_bytes"] > 0);
}

}  // namespace
}  // namespace mpm::http
