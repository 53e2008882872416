#include <catch2/catch.hpp>

#include "tests/daemon/app/commands/kept_journal.hpp"

namespace mpm::test {
namespace {

TEST_CASE("mpm journal tells what happened, by time and by CV") {
  const Journal journal;
  CHECK(journal.run({"journal"}) == 0);
  CHECK(journal.out() ==
        "2026-03-01 06:00:00 UTC  shell  u1 -> y1  active\n"
        "2026-03-01 07:00:00 UTC  shell  u1 -> y2  cleared\n");
  CHECK(journal.run({"journal", "--cv", "y2"}) == 0);
  CHECK(lines_of(journal.out()).size() == 1);
  CHECK(journal.run({"journal", "--until", "2026-03-01T06:30:00Z", "--export", "csv"}) == 0);
  CHECK(lines_of(journal.out()).size() == 2);
  CHECK(journal.run({"journal", "--verify"}) == 0);
  CHECK_THAT(journal.out(), Catch::Matchers::Contains("2 entries, whole"));
}

TEST_CASE("a journal that is not there, and a time that is none, are told") {
  Journal journal;
  CHECK(journal.run({"journal", "--since", "yesterday"}) == 2);
  write_file(journal.path, "no data base, though somebody may think so and give it all the same");
  const auto error = [&journal](const std::string& path) {
    journal.path = path;
    CHECK(journal.run({"journal"}) == 2);
    return read_file(journal.folder.file("err"));
  };
  const std::string own = journal.path;
  CHECK(error(own) == "mpm: error: " + own + ": is no journal of alarms\n");
  CHECK(error("/tmp") ==
        "mpm: error: /tmp: is a folder; the journal is a file, as alarms.sqlite\n");
  CHECK(error("/dev/zero") == "mpm: error: /dev/zero: is no file\n");
  CHECK(error("/nowhere/alarms.sqlite") ==
        "mpm: error: /nowhere/alarms.sqlite: cannot be read: No such file or directory\n");
  write_file(own, "");
  CHECK(error(own) == "mpm: error: " + own + ": is no journal of alarms\n");
}

}  // namespace
}  // namespace mpm::test
