#include "daemon/live/trouble_log.hpp"

#include <catch2/catch.hpp>

namespace mpm::live {
namespace {

using bus::Severity;
using bus::Trouble;
using std::chrono::seconds;

const std::vector<Trouble> kSilent = {{"silent mpm/dv", Severity::kFailure, "nothing on mpm/dv"}};

/// A log that is asked each second; second 1 is 00:00:01.
struct Scene {
  TroubleLog log{seconds(30)};
  std::int64_t second = 0;
  std::vector<TroubleLog::Line> told;

  void tick(const std::vector<Trouble>& troubles) {
    ++second;
    for (const TroubleLog::Line& line :
         log.update(troubles, TroubleLog::Clock::time_point{seconds(1000 + second)}, second))
      told.push_back(line);
  }
  void ticks(int count, const std::vector<Trouble>& troubles) {
    for (int i = 0; i < count; ++i) tick(troubles);
  }
};

}  // namespace

TEST_CASE("a trouble is told once when it begins and once when it is over") {
  Scene scene;
  scene.ticks(61, kSilent);
  REQUIRE(scene.told.size() == 1);
  CHECK(scene.told[0].begins);
  CHECK(scene.told[0].text == "nothing on mpm/dv");
  scene.ticks(29, {});
  CHECK(scene.told.size() == 1);
  scene.tick({});
  REQUIRE(scene.told.size() == 2);
  CHECK_FALSE(scene.told[1].begins);
  CHECK(scene.told[1].text == "over since 00:01:02Z after 60 s: nothing on mpm/dv");
  scene.tick({});
  CHECK(scene.told.size() == 2);
}

// A silence is told after some seconds, and is as long as its text says.
TEST_CASE("a trouble that was so before it was told has lasted since then") {
  Scene scene;
  const auto silent = [&scene](std::int64_t since) {
    std::vector<Trouble> troubles = kSilent;
    troubles[0].since = TroubleLog::Clock::time_point{seconds(1000 + since)};
    troubles[0].text += " for " + std::to_string(scene.second + 1 - since) + " s";
    return troubles;
  };
  scene.ticks(9, {});
  for (int i = 0; i < 10; ++i) scene.tick(silent(5));  // until second 19
  scene.ticks(5, {});
  for (int i = 0; i < 3; ++i) scene.tick(silent(20));  // again, until second 27
  scene.ticks(31, {});
  REQUIRE(scene.told.size() == 2);
  CHECK(scene.told[0].text == "nothing on mpm/dv for 5 s");
  CHECK(scene.told[1].text ==
        "over since 00:00:28Z after 21 s in 2 times: nothing on mpm/dv for 7 s");
}

TEST_CASE("what comes and goes each second does not flood the log") {
  Scene scene;
  for (int i = 0; i < 1000; ++i) {
    std::vector<Trouble> troubles;
    if (i % 2 == 0) troubles = kSilent;
    if (!troubles.empty()) troubles[0].text += " for " + std::to_string(i) + " s";
    scene.tick(troubles);
  }
  CHECK(scene.told.size() == 1);
  scene.ticks(30, {});
  REQUIRE(scene.told.size() == 2);
  CHECK(scene.told[1].text ==
        "over since 00:16:40Z after 0 s in 500 times: nothing on mpm/dv for 998 s");
}

TEST_CASE("a trouble that turns into another one of its kind is told anew") {
  Scene scene;
  scene.ticks(10, {{"no data", Severity::kFailure, "no data for 5 s (it has stopped)"}});
  scene.ticks(5, {});
  scene.ticks(10, {{"no data", Severity::kFailure, "no data for 7 s (nobody writes it)"}});
  REQUIRE(scene.told.size() == 2);
  CHECK(scene.told[1].begins);
  CHECK(scene.told[1].text == "no data for 7 s (nobody writes it)");
  scene.ticks(31, {});
  REQUIRE(scene.told.size() == 3);
  CHECK(scene.told[2].text ==
        "over since 00:00:26Z after 18 s in 2 times: no data for 7 s (nobody writes it)");
}

TEST_CASE("each event is told as it happens, none is over, and many are counted") {
  Scene scene;
  const auto clock = [](const std::string& event, const std::string& text) {
    return Trouble{"clock", Severity::kOutOfSpecification, text, event};
  };
  scene.ticks(60, {clock("199", "stepped forward by 3600 s")});
  scene.ticks(60, {clock("999", "stepped back by 3600 s")});
  scene.ticks(40, {});
  REQUIRE(scene.told.size() == 2);
  CHECK(scene.told[1].text == "stepped back by 3600 s");
  for (int i = 0; i < 60; ++i) scene.tick({clock("1" + std::to_string(i), "stepped")});
  CHECK(scene.told.size() <= 8);
  scene.ticks(60, {});
  scene.tick({clock("5", "stepped")});
  CHECK(scene.told.back().text.find(" more like this before)") != std::string::npos);
}

}  // namespace mpm::live
