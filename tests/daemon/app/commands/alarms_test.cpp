#include <catch2/catch.hpp>

#include "tests/daemon/app/commands/kept_journal.hpp"

namespace mpm::test {
namespace {

TEST_CASE("mpm alarms stats counts what a journal holds") {
  const Journal journal;
  CHECK(journal.run({"alarms", "stats"}) == 0);
  CHECK_THAT(journal.out(), Catch::Matchers::Contains("Engineers (alerts)\n  came        1 time"));
  CHECK(journal.run({"alarms", "stats", "--json"}) == 0);
  CHECK_THAT(journal.out(), Catch::Matchers::Contains("\"annunciated\":1"));
}

}  // namespace
}  // namespace mpm::test
