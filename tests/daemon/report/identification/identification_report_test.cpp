#include "daemon/report/identification/identification_report.hpp"

#include <catch2/catch.hpp>

#include "tests/daemon/report/identification/small_run.hpp"

namespace mpm::test {

TEST_CASE("table and JSON say what was identified and what was left out") {
  const report::IdentificationRun run = small_run();
  const nlohmann::ordered_json json = to_json(run);
  CHECK(json["model"] == "new.yaml");
  CHECK(json["channels"][0]["in_model"] == true);
  CHECK(json["channels"][0]["interval"]["gain"] == nlohmann::ordered_json({1.9, 2.1}));
  CHECK(json["channels"][1]["reason"] == "input_still");
  CHECK(json["inputs"][1]["outside_share"].is_null());
  CHECK(json["operating_point"]["u"] == 5.0);
  const std::string text = to_text(run);
  CHECK(text.find("u: 1 channel of 2 identified") == 0);
  CHECK(text.find("2  [1.9 to 2.1]") != std::string::npos);
  CHECK(text.find("v -> y: v does not move") != std::string::npos);
}

TEST_CASE("innovations that go with an input are said") {
  report::IdentificationRun run = small_run();
  run.identification.cvs[0].rows = 100.0;
  run.identification.cvs[0].input_p_values = {1e-8, 0.5};
  CHECK(to_text(run).find("goes with the past of u") != std::string::npos);
}

}  // namespace mpm::test
