#include "core/alarm/alarm_load.hpp"

#include <catch2/catch.hpp>

namespace mpm::alarm_load_test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000, kMinute = 60 * kSecond, kHour = 60 * kMinute;
using Kind = AlarmLoadEvent::Kind;

TEST_CASE("a day without alarms has no load") {
  const AlarmLoad load = alarm_load({}, 3, 0, 24 * kHour);
  CHECK(load.days == 1.0);
  CHECK(load.annunciated == 0);
  CHECK(load.per_day == 0.0);
  CHECK(load.floods == 0);
  CHECK(load.time_in_flood == 0.0);
}

TEST_CASE("alarms are counted by day, by priority and by alarm") {
  const AlarmLoad load = alarm_load({{0, 0, Kind::kAnnunciated, AlarmPriority::kHigh},
                                     {kHour, 1, Kind::kAnnunciated, AlarmPriority::kLow},
                                     {2 * kHour, 1, Kind::kEnded, AlarmPriority::kLow},
                                     {3 * kHour, 1, Kind::kAnnunciated, AlarmPriority::kLow}},
                                    2, 0, 12 * kHour);
  CHECK(load.annunciated == 3);
  CHECK(load.per_day == 6.0);
  CHECK(load.by_priority == std::array<std::uint64_t, 3>{2, 0, 1});
  CHECK(load.by_alarm == std::vector<std::uint64_t>{1, 2});
  CHECK(load.most_in_10_min == 1);
}

// Twelve alarms a minute apart. The eleventh, at 10 min, finds the first gone from the window; with
// 50 s between them it does not.
TEST_CASE("a flood begins with more than ten alarms in ten minutes and ends below five") {
  const auto every = [](std::int64_t seconds) {
    std::vector<AlarmLoadEvent> events;
    for (int i = 0; i < 12; ++i) events.push_back({i * seconds * kSecond, i, Kind::kAnnunciated});
    return alarm_load(events, 12, 0, 10 * kHour);
  };
  CHECK(every(60).floods == 0);
  CHECK(every(60).most_in_10_min == 10);
  const AlarmLoad load = every(50);
  CHECK(load.floods == 1);
  CHECK(load.most_in_10_min == 12);
  // It begins with the eleventh, at 500 s, and ends when eight of twelve have left the window: the
  // eighth came at 350 s and leaves at 950 s.
  CHECK(load.time_in_flood == Approx(450.0 / 36000.0));
}

TEST_CASE("an alarm that comes three times within a minute chatters, two that alternate do not") {
  const auto at = [](std::initializer_list<std::pair<int, int>> seconds_and_alarms) {
    std::vector<AlarmLoadEvent> events;
    for (const auto& [second, alarm] : seconds_and_alarms)
      events.push_back({second * kSecond, alarm, Kind::kAnnunciated});
    return alarm_load(events, 2, 0, kHour).chattering;
  };
  CHECK(at({{0, 0}, {20, 0}, {59, 0}}) == 1);
  CHECK(at({{0, 0}, {20, 0}, {60, 0}}) == 0);
  CHECK(at({{0, 0}, {10, 1}, {20, 0}, {30, 1}}) == 0);
}

TEST_CASE("an alarm that stands for more than a day is stale, whether it has ended or not") {
  const auto stood = [](std::int64_t hours, bool ended) {
    std::vector<AlarmLoadEvent> events = {{0, 0, Kind::kAnnunciated}};
    if (ended) events.push_back({hours * kHour, 0, Kind::kEnded});
    return alarm_load(events, 1, 0, ended ? 100 * kHour : hours * kHour).stale;
  };
  CHECK(stood(24, true) == 0);
  CHECK(stood(25, true) == 1);
  CHECK(stood(24, false) == 0);
  CHECK(stood(25, false) == 1);
}

}  // namespace
}  // namespace mpm::alarm_load_test
