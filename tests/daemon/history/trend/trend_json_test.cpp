#include "daemon/history/trend/trend_json.hpp"

#include <catch2/catch.hpp>

#include "tests/daemon/history/sample_history.hpp"

namespace mpm::history {

TEST_CASE("a trend as JSON has periods, changes and what cannot be told") {
  const Trend trend = test::changing_trend(30, 12, -20.0, 0.25);
  Findings findings = find_changes(trend);
  findings.standing = {{"u", "y", {}, kUnknown, kUnknown, kUnknown}};
  findings.silent = {{trend.last[0], std::size_t{3}}};
  const auto json = to_json(trend, findings, nullptr);
  CHECK(json["unit"] == "sample");
  CHECK(json["by"] == "day");
  CHECK(json["horizon"] == 600.0);
  REQUIRE(json["periods"].size() == 30);
  const auto& day = json["periods"][12];
  CHECK(day["name"] == "17 January");
  CHECK(day["from"] == 1767571200.0 + 12 * 86400.0);
  CHECK(day["cvs"][0]["prediction_rms"].get<double>() == Approx(0.25).epsilon(0.02));
  CHECK(day["channels"][0]["gain_error_percent"].get<double>() == Approx(-20.0).margin(0.1));
  CHECK(day["channels"][0]["mismatch"] == 1.0);
  REQUIRE(json["changes"].size() == 2);
  CHECK(json["changes"][0]["what"] == "prediction_error");
  CHECK(json["changes"][1]["what"] == "gain");
  CHECK(json["changes"][1]["since"] == day["from"]);
  CHECK(json["changes"][1]["since_period"] == "17 January");
  CHECK(json["in_alarm"][0]["since"].is_null());
  CHECK(json["cannot_tell"][0]["mv"] == "u");
}

}  // namespace mpm::history
