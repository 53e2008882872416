#include "daemon/http/recent_events.hpp"

#include <catch2/catch.hpp>

namespace mpm::http {
namespace {

AlarmRecord alarm(const std::string& unit, const std::string& cv, std::int64_t time_ns) {
  AlarmRecord record;
  record.unit = unit;
  record.mv = "u1";
  record.cv = cv;
  record.to = AlarmChange::kActive;
  record.source_time_ns = time_ns;
  return record;
}

TEST_CASE("events are chosen by time, unit and CV, the youngest first") {
  RecentEvents events;
  for (int k = 1; k <= 4; ++k) events.add(alarm(k % 2 == 0 ? "a" : "b", "y1", k), "gain +41 %");
  EventQuery query;
  const auto all = events.query(query);
  REQUIRE(all.size() == 4);
  CHECK(all.front()["time_ns"] == 4);
  CHECK(all.front()["record"] == "alarm");
  CHECK(all.front()["text"] == "gain +41 %");
  query.unit = "a";
  CHECK(events.query(query).size() == 2);
  query.since_ns = 3;
  CHECK(events.query(query).size() == 1);
  query.until_ns = 3;
  CHECK(events.query(query).empty());
  CHECK(events.query({.since_ns = {}, .until_ns = {}, .unit = "", .mv = "", .cv = "y2"}).empty());
  query = {};
  query.most = 1;
  CHECK(events.query(query).size() == 1);
}

TEST_CASE("of many events the last ones are kept") {
  RecentEvents events(3);
  for (int k = 1; k <= 10; ++k) events.add(alarm("a", "y1", k), "");
  const auto all = events.query({});
  REQUIRE(all.size() == 3);
  CHECK(all.back()["time_ns"] == 8);
}

}  // namespace
}  // namespace mpm::http
