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
  const Journal journal;
  CHECK(journal.run({"journal", "--since", "yesterday"}) == 2);
  write_file(journal.path, "no data base, though somebody may think so and give it all the same");
  CHECK(journal.run({"journal"}) == 2);
  CHECK_THAT(read_file(journal.folder.file("err")), Catch::Matchers::StartsWith("mpm: error: "));
}

}  // namespace
}  // namespace mpm::test
