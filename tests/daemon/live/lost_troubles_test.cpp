#include "daemon/live/lost_troubles.hpp"

#include <catch2/catch.hpp>

#include "config/load_unit.hpp"
#include "daemon/bus/doctor/findings.hpp"

namespace mpm::live::lost_troubles_test {
namespace {

using bus::Severity;

config::UnitConfig toy() {
  config::LoadResult loaded = config::load_unit_text(R"(
unit: toy
sample_time: 1.0
signals: {mv: [u1, u2], dv: [d1], cv: [{tag: y1, prediction: p1}]}
model:
  channels:
    - {cv: y1, mv: u1, gain: 2, time_constants: [5]}
)",
                                                     "toy.yaml");
  REQUIRE(loaded.ok());
  return std::move(loaded.config);
}

constexpr std::int64_t kTime = 1'700'000'000'000'000'000;

}  // namespace

TEST_CASE("health names the tags without usable values, since when and why") {
  const auto troubles =
      lost_troubles(toy(), {{SignalKind::kCv, 0, LossCause::kQuality, kTime}}, {});
  REQUIRE(troubles.size() == 1);
  CHECK(troubles[0].severity == Severity::kOutOfSpecification);
  CHECK(troubles[0].text == "y1 is bad since 2023-11-14T22:13:20Z: quality bad");
  CHECK(bus::advice(troubles[0]) == "See to the instruments and their link to the control system.");
  const auto many = lost_troubles(toy(),
                                  {{SignalKind::kMv, 0, LossCause::kNoValue, kTime + 5'000'000'000},
                                   {SignalKind::kMv, 1, LossCause::kNoValue, kTime},
                                   {SignalKind::kDv, 0, LossCause::kNoValue, kTime},
                                   {SignalKind::kCv, 0, LossCause::kImplausible, kTime},
                                   {SignalKind::kPrediction, 0, LossCause::kNoValue, kTime}},
                                  {});
  REQUIRE(many.size() == 2);
  CHECK(many[0].text ==
        "u1, u2, d1 and 1 other are bad, the first since 2023-11-14T22:13:20Z: no value");
  CHECK(many[1].text.find("y1 is bad since 2023-11-14T22:13:20Z: not plausible (frozen") == 0);
}

TEST_CASE("a topic that does not come is one trouble, not its signals' too") {
  const std::vector<LostSignal> lost = {{SignalKind::kDv, 0, LossCause::kNoValue, kTime},
                                        {SignalKind::kCv, 0, LossCause::kQuality, kTime}};
  const auto troubles = lost_troubles(
      toy(), lost, {{"silent mpm/dv", Severity::kOutOfSpecification, "nothing on mpm/dv"}});
  REQUIRE(troubles.size() == 1);
  CHECK(troubles[0].text.find("y1 ") == 0);
  CHECK(lost_troubles(toy(), {lost[0]},
                      {{"clock", Severity::kOutOfSpecification,
                        "the clock of the control system stepped back by 60 s on mpm/dv", "9"}})
            .size() == 1);
  CHECK(lost_troubles(toy(), lost, {{"no data", Severity::kFailure, "no data"}}).empty());
}

TEST_CASE("a gap explains what it left out, and no value that is missing behind it") {
  bus::Trouble gap{"jump", Severity::kOutOfSpecification,
                   "no intervals came between 9 and 99 on mpm/dv", "9 99"};
  gap.until_ns = kTime + 90'000'000'000;
  LostSignal signal{SignalKind::kDv, 0, LossCause::kNoValue, kTime, kTime + 89'000'000'000};
  CHECK(lost_troubles(toy(), {signal}, {gap}).empty());
  signal.last_ns = gap.until_ns;  // it came back without a value
  CHECK(lost_troubles(toy(), {signal}, {gap}).size() == 1);
  signal.since_ns = gap.until_ns + 10'000'000'000;
  signal.last_ns = gap.until_ns + 50'000'000'000;
  REQUIRE(lost_troubles(toy(), {signal}, {gap}).size() == 1);
  CHECK(lost_troubles(toy(), {signal}, {gap})[0].text ==
        "d1 is bad since 2023-11-14T22:15:00Z: no value");
}

}  // namespace mpm::live::lost_troubles_test
