#include "daemon/app/commands/journal_place.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <stdexcept>

namespace mpm::app {
namespace {

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

TEST_CASE("entries are wanted since a time, or since so long ago") {
  JournalPlace place;
  CHECK_FALSE(query_of(place).since_ns);
  place.since = "2026-03-01T06:00:00Z";
  CHECK(query_of(place).since_ns == 1'772'344'800'000'000'000);
  place.since = "2026-03-01T07:00:00+01:00";
  CHECK(query_of(place).since_ns == 1'772'344'800'000'000'000);
  place.until = "8h";
  const std::int64_t ago = now_ns() - query_of(place).until_ns.value_or(0);
  CHECK(ago > 28'790'000'000'000);
  CHECK(ago < 28'810'000'000'000);
}

TEST_CASE("what is no time is told with its option") {
  JournalPlace place;
  for (const char* text : {"yesterday", "2026-03-01", "-8h", "0", "2026-03-01T06:00:00"}) {
    place.since = text;
    CAPTURE(text);
    CHECK_THROWS_WITH(query_of(place), Catch::Matchers::StartsWith("--since: '"));
  }
}

}  // namespace
}  // namespace mpm::app
