#include "daemon/report/page/identification_page.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "tests/daemon/report/identification/identified_run.hpp"

namespace mpm::test::identification_page_test {
namespace {

using Json = nlohmann::ordered_json;

TEST_CASE("an identification has the same page") {
  const Json data = report::page_data(identified_run());
  CHECK(data["title"] == "Model of u");
  CHECK(data["sentence"] ==
        "1 of 2 channels of u was identified; the others are left out, with the reason.");
  CHECK(data["matrix"]["rows"][0]["cells"][0] == Json({{"state", "right"}, {"text", "gain 2.00"}}));
  CHECK(data["matrix"]["rows"][0]["cells"][1]["text"] == "input still");
  CHECK(data["numbers"]["rows"][0]["gain"]["new"] == "2.00");
  REQUIRE(data["responses"].size() == 1);
  CHECK(data["responses"][0]["bands"][0]["high"][0] == Approx(1.96 * 0.05).margin(1e-3));
  CHECK(data["refused"][0] == "v \u2192 y: v does not move.");
  CHECK(data["views"].size() == 1);
}

}  // namespace
}  // namespace mpm::test::identification_page_test
