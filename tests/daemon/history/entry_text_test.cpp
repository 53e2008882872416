#include "daemon/history/entry_text.hpp"

#include <catch2/catch.hpp>

namespace mpm::history::entry_text_test {
namespace {

AlarmEntry entry() {
  AlarmEntry entry;
  entry.written_ns = 1'772'344'800'000'000'000;  // 2026-03-01 06:00 UTC
  entry.source_time_ns = entry.written_ns - 1'500'000'000;
  entry.unit = "shell";
  entry.mv = "u1";
  entry.cv = "y1";
  entry.what = "shelved";
  entry.standing.shelving = Shelving::kTimed;
  entry.user = "ann";
  entry.host = "panel";
  entry.comment = "known";
  entry.message = "gain +41 %";
  return entry;
}

TEST_CASE("an entry is a line that people read") {
  CHECK(entry_text(entry()) ==
        "2026-03-01 06:00:00 UTC  shell  u1 -> y1  shelved by ann on panel: known (gain +41 %)");
  AlarmEntry plain = entry();
  plain.mv = plain.cv = plain.user = plain.comment = plain.message = "";
  plain.what = "active";
  CHECK(entry_text(plain) == "2026-03-01 06:00:00 UTC  shell  controller  active");
  plain.what = "suppressed";
  plain.standing.suppressed_by_design = true;
  CHECK(
      entry_text(plain) ==
      "2026-03-01 06:00:00 UTC  shell  controller  suppressed by design: the controller is off or "
      "the data are bad");
  AlarmEntry hostile = entry();
  hostile.comment = "a\n2026-03-01 forged";
  CHECK(entry_text(hostile).find('\n') == std::string::npos);
}

TEST_CASE("an entry is a row of a table, whatever its comment") {
  CHECK(entry_csv(entry()) ==
        "2026-03-01T06:00:00Z,2026-03-01T05:59:58.500Z,shell,u1,y1,shelved,shelved,alert,low,ann,"
        "panel,known,gain +41 %");
  AlarmEntry quoted = entry();
  quoted.comment = "he said \"no\", twice\n";
  CHECK_THAT(entry_csv(quoted), Catch::Matchers::Contains(",\"he said \"\"no\"\", twice\n\","));
  quoted.comment = "=HYPERLINK(\"x\")";  // a spreadsheet would run it
  CHECK_THAT(entry_csv(quoted), Catch::Matchers::Contains(",\"'=HYPERLINK(\"\"x\"\")\","));
}

TEST_CASE("the head of the table has a name for each column") {
  const auto commas = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  CHECK(commas(entry_csv_head()) == commas(entry_csv(entry())));
}

TEST_CASE("an entry is an object") {
  const auto json = entry_json(entry());
  CHECK(json["alarm_state"] == "shelved");
  CHECK(json["written_ns"] == 1'772'344'800'000'000'000);
  CHECK(json["user"] == "ann");
}

}  // namespace
}  // namespace mpm::history::entry_text_test
