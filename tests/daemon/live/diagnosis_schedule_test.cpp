#include "daemon/live/diagnosis_schedule.hpp"

#include <catch2/catch.hpp>
#include <vector>

namespace mpm::live::diagnosis_schedule_test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

/// A unit with one frame per second and an endless ring.
class Unit {
 public:
  explicit Unit(const ScheduleSettings& settings) : schedule_(settings) {}

  /// Runs to second `end`, the alarm standing or not; when diagnoses began.
  std::vector<int> run(int end, bool active) {
    std::vector<int> starts;
    for (; now_ < end; ++now_) {
      const bool raised = active && !active_;
      active_ = active;
      if (schedule_.due(now_ * kSecond, now_ + 1, raised, active)) starts.push_back(now_);
    }
    return starts;
  }
  /// Another channel's alarm, besides the one that stands.
  bool raise() {
    ++now_;
    return schedule_.due((now_ - 1) * kSecond, now_, true, true);
  }

 private:
  DiagnosisSchedule schedule_;
  int now_ = 0;
  bool active_ = false;
};

}  // namespace

TEST_CASE("an alarm is diagnosed when it has settled, and again when its samples have doubled") {
  Unit unit({.needed_rows = 150, .settling_rows = 300, .renewed_rows = 1000, .period_ns = 0});
  CHECK(unit.run(1000, false).empty());
  CHECK(unit.run(5000, true) == std::vector<int>{1300, 1600, 2200, 3200, 4200});
  CHECK(unit.run(6000, false).empty());
  CHECK(unit.run(6500, true) == std::vector<int>{6300});
}

TEST_CASE("too few samples are waited for") {
  Unit unit({.needed_rows = 700, .settling_rows = 300, .renewed_rows = 1000, .period_ns = 0});
  CHECK(unit.run(100, false).empty());
  CHECK(unit.run(800, true) == std::vector<int>{699});
}

TEST_CASE("an alarm that clears before it settled is not diagnosed") {
  Unit unit({.needed_rows = 0, .settling_rows = 300, .renewed_rows = 1000, .period_ns = 0});
  CHECK(unit.run(299, true).empty());
  CHECK(unit.run(2000, false).empty());
}

TEST_CASE("a new alarm is reason for a new diagnosis, and the period is kept in source time") {
  Unit unit(
      {.needed_rows = 0, .settling_rows = 100, .renewed_rows = 10'000, .period_ns = 600 * kSecond});
  CHECK(unit.run(150, true) == std::vector<int>{100});
  CHECK_FALSE(unit.raise());
  CHECK(unit.run(1000, true) == std::vector<int>{700});  // not at 250
  SECTION("a clock that is set back begins the period anew") {
    DiagnosisSchedule schedule(
        {.needed_rows = 0, .settling_rows = 1, .renewed_rows = 1, .period_ns = 10 * kSecond});
    CHECK_FALSE(schedule.due(1000 * kSecond, 1, true, true));
    CHECK(schedule.due(1001 * kSecond, 2, false, true));
    CHECK_FALSE(schedule.due(5 * kSecond, 3, false, true));
    CHECK_FALSE(schedule.due(14 * kSecond, 4, false, true));
    CHECK(schedule.due(15 * kSecond, 5, false, true));
  }
}

TEST_CASE("the fit sees half of what came after the alarm, and no less than usual of all") {
  CHECK(unseen_rows(6000, 300) == 150);
  CHECK(unseen_rows(6000, 2000) == 1000);
  CHECK(unseen_rows(6000, 100'000) == 2000);
  CHECK(unseen_rows(6000, 10) == 100);
  CHECK(unseen_rows(90, 50) == 30);
}

}  // namespace mpm::live::diagnosis_schedule_test
