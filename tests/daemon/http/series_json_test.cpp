#include "daemon/http/series_json.hpp"

#include <catch2/catch.hpp>

#include "tests/daemon/http/sample_board.hpp"

namespace mpm::http {
namespace {

TEST_CASE("a series has one entry of each column a time") {
  test::SampleBoard sample;
  sample.push(100);
  const Json json = series_json(sample.store(), 0, {});
  const std::size_t times = json["times"].size();
  CHECK(times == 100);
  for (const char* name : {"measured", "residual"})
    for (const char* part : {"mean", "min", "max"}) CHECK(json[name][part].size() == times);
  CHECK(json["prediction"].size() == times);
  CHECK(json["setpoint"].size() == times);
  CHECK(json["setpoint"][0].is_null());
  CHECK(json["inputs"].size() == 3);
  CHECK(json["inputs"][1]["mean"].size() == times);
  CHECK(json["last"] == 6000.0);
  CHECK(json["cv_unit"] == "t/h");
}

TEST_CASE("a stretch is chosen in seconds, with so many points") {
  test::SampleBoard sample;
  sample.push(1000);
  SeriesQuery query;
  query.from_s = 600.0;
  query.until_s = 1200.0;
  const Json few = series_json(sample.store(), 1, query);
  CHECK(few["times"].size() == 11);
  CHECK(few["times"][0] == 600.0);
  query = {};
  query.span_s = 300.0;
  CHECK(series_json(sample.store(), 1, query)["from"] == 60'000.0 - 300.0);
  query = {};
  query.from_s = 0.0;
  query.points = 20;
  CHECK(series_json(sample.store(), 1, query)["times"].size() <= 21);
}

TEST_CASE("wild times choose nothing and break nothing") {
  test::SampleBoard sample;
  CHECK(series_json(sample.store(), 0, {})["times"].empty());
  sample.push(10);
  SeriesQuery query;
  query.from_s = 1e300;
  query.until_s = -1e300;
  query.points = -5;
  CHECK(series_json(sample.store(), 0, query)["times"].empty());
  for (const double from : {1e10, 9.3e9, -1e10})
    for (const double until : {1e10, 9.3e9, 0.0}) {
      query = {};
      query.from_s = from;
      query.until_s = until;
      query.span_s = 1e300;
      CHECK(series_json(sample.store(), 0, query)["from"] <= 9e9);
    }
}

}  // namespace
}  // namespace mpm::http
