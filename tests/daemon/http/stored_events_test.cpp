#include "daemon/http/stored_events.hpp"

#include <catch2/catch.hpp>

#include "daemon/history/alarm_store.hpp"
#include "tests/system/process.hpp"

namespace mpm::http {
namespace {

history::AlarmEntry entry(std::int64_t time_ns, const std::string& what, const std::string& cv) {
  history::AlarmEntry entry;
  entry.written_ns = time_ns;
  entry.unit = "shell";
  entry.mv = cv.empty() ? "" : "u1";
  entry.cv = cv;
  entry.what = what;
  entry.user = "ann";
  entry.comment = "known";
  entry.message = "gain +41 %";
  return entry;
}

TEST_CASE("the journal's entries are events, the youngest first, as many as are wanted") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("alarms.sqlite");
  const StoredEvents events(path);
  CHECK(events.query({}).empty());
  history::AlarmStore store(path, history::AlarmStore::Access::kAppend);
  store.append({entry(10, "active", "y1"), entry(20, "diagnosed", "y1"), entry(30, "shelved", "")});
  const auto all = events.query({});
  REQUIRE(all.size() == 3);
  CHECK(all[0]["to"] == "shelved");
  CHECK(all[0]["cv"] == "");
  CHECK(all[0]["client_user_id"] == "ann");
  CHECK(all[0]["suppressed_by_design"] == false);
  CHECK(all[1]["record"] == "diagnosis");
  CHECK(all[2]["text"] == "gain +41 %");
  EventQuery query;
  query.since_ns = 10;
  query.until_ns = 20;
  CHECK(events.query(query).size() == 2);
  query.cv = "y2";
  CHECK(events.query(query).empty());
  query = {};
  query.most = 1;
  REQUIRE(events.query(query).size() == 1);
  CHECK(events.query(query)[0]["to"] == "shelved");
}

}  // namespace
}  // namespace mpm::http
