#include "daemon/live/trouble_log.hpp"

#include <catch2/catch.hpp>

namespace mpm::live {
namespace {

using bus::Severity;
using bus::Trouble;
using std::chrono::seconds;

const std::vector<Trouble> kSilent = {{"silent mpm/dv", Severity::kFailure, "nothing on mpm/dv"}};

}  // namespace

TEST_CASE("a trouble is told once when it begins and once when it is over") {
  TroubleLog log(seconds(30));
  TroubleLog::Clock::time_point now{seconds(1000)};
  std::vector<TroubleLog::Line> told;
  const auto tick = [&](const std::vector<Trouble>& troubles) {
    now += seconds(1);
    for (const TroubleLog::Line& line : log.update(troubles, now)) told.push_back(line);
  };
  for (int i = 0; i < 61; ++i) tick(kSilent);
  REQUIRE(told.size() == 1);
  CHECK(told[0].begins);
  CHECK(told[0].text == "nothing on mpm/dv");
  for (int i = 0; i < 29; ++i) tick({});
  CHECK(told.size() == 1);
  tick({});
  REQUIRE(told.size() == 2);
  CHECK_FALSE(told[1].begins);
  CHECK(told[1].text == "over after 60 s: nothing on mpm/dv");
  tick({});
  CHECK(told.size() == 2);
}

TEST_CASE("what comes and goes each second does not flood the log") {
  TroubleLog log(seconds(30));
  TroubleLog::Clock::time_point now{seconds(1000)};
  std::size_t lines = 0;
  for (int i = 0; i < 1000; ++i) {
    now += seconds(1);
    std::vector<Trouble> troubles;
    if (i % 2 == 0) troubles = kSilent;
    if (!troubles.empty()) troubles[0].text += " for " + std::to_string(i) + " s";
    lines += log.update(troubles, now).size();
  }
  CHECK(lines == 1);
}

}  // namespace mpm::live
