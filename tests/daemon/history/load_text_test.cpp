#include "daemon/history/load_text.hpp"

#include <catch2/catch.hpp>

#include "tests/system/process.hpp"

namespace mpm::history::load_text_test {
namespace {

constexpr std::int64_t kHour = 3'600'000'000'000;

AlarmEntry entry(std::int64_t hour, const std::string& what, Annunciation annunciation,
                 const std::string& cv = "") {
  AlarmEntry entry;
  entry.written_ns = 400'000 * kHour + hour * kHour;
  entry.unit = "shell";
  entry.mv = cv.empty() ? "" : "u1";
  entry.cv = cv;
  entry.what = what;
  entry.standing.annunciation = annunciation;
  if (cv.empty()) entry.notification_class = NotificationClass::kAlarm;
  return entry;
}

struct Journal {
  test::TemporaryFolder folder;
  AlarmStore store{folder.file("alarms.sqlite"), AlarmStore::Access::kAppend};
};

TEST_CASE("what operators and what engineers were asked is counted apart") {
  Journal journal;
  using enum Annunciation;
  AlarmEntry shelved = entry(13, "active", kUnacknowledged, "y2");
  shelved.standing.shelving = Shelving::kTimed;
  journal.store.append({entry(0, "active", kUnacknowledged, "y1"),
                        entry(0, "active", kUnacknowledged),
                        entry(1, "acknowledged", kAcknowledged), entry(2, "refused", kAcknowledged),
                        entry(12, "cleared", kNormal), entry(13, "active", kUnacknowledged),
                        shelved, entry(24, "cleared", kReturned)});
  const LoadReport report = load_report(journal.store, {});
  CHECK(report.operators.names == std::vector<std::string>{"shell"});
  CHECK(report.operators.load.annunciated == 2);
  CHECK(report.operators.load.days == 1.0);
  CHECK(report.engineers.load.annunciated == 1);  // what was shelved called nobody
  CHECK(report.engineers.load.stale == 0);
  CHECK_THAT(load_text(report), Catch::Matchers::Contains("2 times, 2 a day"));
  CHECK(load_json(report)["operators"]["most_frequent"][0]["alarm"] == "shell");
}

TEST_CASE("what comes back from its shelf unseen calls again") {
  Journal journal;
  using enum Annunciation;
  journal.store.append({entry(0, "active", kUnacknowledged), entry(5, "unshelved", kUnacknowledged),
                        entry(6, "acknowledged", kAcknowledged),
                        entry(7, "unshelved", kAcknowledged)});
  CHECK(load_report(journal.store, {}).operators.load.annunciated == 2);
}

TEST_CASE("an empty journal is said to hold too little") {
  Journal journal;
  CHECK_THAT(load_text(load_report(journal.store, {})), Catch::Matchers::Contains("too little"));
}

}  // namespace
}  // namespace mpm::history::load_text_test
