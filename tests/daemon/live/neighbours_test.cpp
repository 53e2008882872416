#include "daemon/live/neighbours.hpp"

#include <catch2/catch.hpp>

namespace mpm::live::neighbours_test {
namespace {

using Clock = Neighbours::Clock;
using std::chrono::seconds;

const Clock::time_point kStart{seconds(1000)};

std::string told(const Neighbours& neighbours, Clock::time_point now) {
  bus::Surroundings around;
  around.self = "mpmd (process 1 on host a)";
  const auto troubles = neighbours.troubles(around, now);
  return troubles.empty() ? "" : troubles[0].text;
}

}  // namespace

TEST_CASE("a monitor that nobody arranged is named, the same by each, until it is silent") {
  Neighbours neighbours("unit");
  CHECK_FALSE(neighbours.stands_by());
  CHECK(told(neighbours, kStart).empty());
  neighbours.hear(7, "mpmd (process 2 on host b)", kStart);
  CHECK(
      told(neighbours, kStart + seconds(9)) ==
      "2 monitors watch this unit: mpmd (process 1 on host a), mpmd (process 2 on host b); readers "
      "see them in turn");
  CHECK(told(neighbours, kStart + seconds(10)).empty());
  neighbours.hear(7, "mpmd (process 2 on host b)", kStart + seconds(20));
  neighbours.hear_none();
  CHECK(told(neighbours, kStart + seconds(20)).empty());
}

TEST_CASE("many others are named in part") {
  Neighbours neighbours("unit");
  for (std::uint64_t other = 0; other < 8; ++other)
    neighbours.hear(other, "other " + std::to_string(other), kStart);
  CHECK(told(neighbours, kStart)
            .find("9 monitors watch this unit: mpmd (process 1 on host a), "
                  "other 0, other 1 ... (6 more)") == 0);
}

TEST_CASE("what stands is said again while another speaks, and all once it has left") {
  Neighbours neighbours("unit");
  CHECK_FALSE(neighbours.to_say_again(kStart));
  neighbours.hear(7, "other", kStart);
  CHECK(neighbours.to_say_again(kStart + seconds(1)) == false);
  CHECK(neighbours.to_say_again(kStart + seconds(9)) == false);
  CHECK(neighbours.to_say_again(kStart + seconds(11)) == true);
  CHECK_FALSE(neighbours.to_say_again(kStart + seconds(12)));
}

}  // namespace mpm::live::neighbours_test
