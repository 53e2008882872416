#include "daemon/host/locked_places.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <stdexcept>

#include "tests/system/process.hpp"

namespace mpm::host::locked_places_test {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

TEST_CASE("a place that is removed while it is held is locked anew, which is said once") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("state"), lock = place + "/.lock";
  fs::create_directory(place);
  LockedPlaces places({lock, folder.file("other.lock")});
  CHECK(places.problems().empty());
  CHECK(places.look().empty());
  for (int round = 0; round < 2; ++round) {
    fs::remove_all(place);
    const std::vector<std::string> said = places.look();
    REQUIRE(said.size() == 1);
    CHECK(said[0] == lock +
                         " was removed while this process held it, and what else was removed "
                         "there is lost; it is made and held anew");
    CHECK(places.look().empty());
    CHECK_THROWS_WITH(LockFile(lock),
                      Contains("is held by process " + std::to_string(getpid()) + " on host "));
  }
}

TEST_CASE("a place that cannot be made anew is told once, and locked as soon as it can be") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("state"), lock = place + "/.lock";
  fs::create_directory(place);
  LockedPlaces places({lock});
  fs::remove_all(place);
  test::write_file(place, "a file of that name");
  const std::vector<std::string> lost = places.look();
  REQUIRE(lost.size() == 1);
  CHECK_THAT(lost[0], Contains("it cannot be made: " + lock + ": Not a directory"));
  CHECK(places.look().empty());
  fs::remove(place);
  CHECK(places.look() == std::vector<std::string>{lock + " is made and held anew"});
  CHECK(places.look().empty());
}

TEST_CASE("where another one was quicker, this one may not go on") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("state"), lock = place + "/.lock";
  fs::create_directory(place);
  LockedPlaces places({lock});
  fs::remove_all(place);
  fs::create_directory(place);
  const LockFile other(lock);
  CHECK_THROWS_WITH(places.look(), Contains(lock + ": is held by process "));
}

TEST_CASE("what could not be locked from the start is told") {
  LockedPlaces places({"/proc/none/.lock"});
  CHECK(places.problems() ==
        std::vector<std::string>{"/proc/none/.lock: No such file or directory"});
  CHECK(places.look().empty());
}

}  // namespace
}  // namespace mpm::host::locked_places_test
