#include "daemon/bus/watch/speakers.hpp"

#include <catch2/catch.hpp>

namespace mpm::bus {
namespace {

using namespace std::chrono_literals;
constexpr Speakers::Clock::time_point kStart{1h};

}  // namespace

TEST_CASE("of two monitors of a unit the first is listened to, and both are named") {
  Speakers speakers;
  for (int s = 0; s < 60; ++s) {
    CHECK(speakers.listens_to("shell", "mpmd (process 1)", kStart + s * 1s));
    CHECK_FALSE(speakers.listens_to("shell", "mpmd (process 2)", kStart + s * 1s));
    CHECK(speakers.listens_to("boiler", "mpmd (process 2)", kStart + s * 1s));
  }
  CHECK(speakers.note("shell", kStart + 60s) ==
        "two monitors publish for it: mpmd (process 1), mpmd (process 2); what follows is of the "
        "first");
  CHECK(speakers.note("boiler", kStart + 60s).empty());
  CHECK(speakers.note("nobody", kStart).empty());
  CHECK_FALSE(speakers.listens_to("shell", "mpmd (process 3)", kStart + 60s));
  CHECK(speakers.note("shell", kStart + 60s).starts_with("3 monitors publish for it: "));
}

TEST_CASE("the second monitor is listened to once the first has left or is silent") {
  Speakers speakers;
  CHECK(speakers.listens_to("shell", "a", kStart));
  CHECK_FALSE(speakers.listens_to("shell", "b", kStart + 4s));
  const bool said = GENERATE(true, false);
  if (said) speakers.leaves("shell", "a");
  const auto later = kStart + (said ? 4s : 5s);
  CHECK(speakers.listens_to("shell", "b", later));
  CHECK(speakers.note("shell", later).empty());
  CHECK_FALSE(speakers.listens_to("shell", "a", later + 1s));  // it is the second now
}

TEST_CASE("names that anybody may make up have an end") {
  Speakers speakers;
  CHECK(speakers.listens_to("shell", "first", kStart));
  for (int k = 0; k < 1000; ++k)
    CHECK_FALSE(speakers.listens_to("shell", std::to_string(k), kStart));
  CHECK(speakers.note("shell", kStart).starts_with("16 monitors"));
}

}  // namespace mpm::bus
