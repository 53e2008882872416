#include "daemon/history/trend/changes.hpp"

#include <catch2/catch.hpp>

#include "tests/daemon/history/sample_history.hpp"

namespace mpm::history {
namespace {

using test::changing_trend;

TEST_CASE("a gain that changed is told with its day, and so are prediction errors") {
  const Findings findings = find_changes(changing_trend(30, 12, -20.0, 0.25));
  REQUIRE(findings.changes.size() == 2);
  const Change& errors = findings.changes[0];
  CHECK(errors.mv.empty());
  CHECK(errors.cv == "y");
  CHECK_FALSE(errors.gradual);
  CHECK(errors.first == 12);
  CHECK(errors.now == Approx(2.5).epsilon(0.02));  // 0.25 of 0.1
  CHECK(errors.low < 2.5);
  CHECK(errors.high > 2.5);
  CHECK(errors.movement_ratio == Approx(1.0));
  const Change& gain = findings.changes[1];
  CHECK(gain.mv == "u");
  CHECK(gain.first == 12);
  CHECK(gain.before == Approx(0.0).margin(0.1));
  CHECK(gain.now == Approx(-20.0).margin(0.1));
  CHECK(gain.low == Approx(-22.0).margin(0.1));
  CHECK_FALSE(gain.alarm_ns);
  CHECK(findings.asked == 2);
}

TEST_CASE("nothing is told where nothing changed, nor what is too small to matter") {
  CHECK(find_changes(changing_trend(30, 30, 0.0, 0.1)).changes.empty());
  CHECK(find_changes(changing_trend(30, 12, 4.0, 0.12)).changes.empty());  // 5 %, 1.25 times
  CHECK(find_changes(changing_trend(30, 12, 6.0, 0.13)).changes.size() == 2);
}

TEST_CASE("of few periods no change is told") {
  const Findings findings = find_changes(changing_trend(5, 3, -40.0, 0.5));
  CHECK(findings.changes.empty());
  CHECK(findings.asked == 0);
}

TEST_CASE("a gain that decays is told with the first day that differs") {
  const Trend trend = test::sample_trend(
      96 * 40,
      [](int q, std::int64_t at) {
        const double days = q / 96.0;
        return test::sample_digest(at, -std::max(0.0, days - 15.0) + 0.3 * test::uniform(7, q),
                                   0.1);
      },
      Step::kDay);
  const Findings findings = find_changes(trend);
  REQUIRE(findings.changes.size() == 1);
  CHECK(findings.changes[0].gradual);
  CHECK(std::abs(static_cast<int>(findings.changes[0].first) - 15) <= 1);
  CHECK(findings.changes[0].now == Approx(-24.5).margin(0.2));
}

TEST_CASE("an alarm about the time of a change tells its moment") {
  Trend trend = changing_trend(30, 12, -20.0, 0.1);
  const auto day = [](double days) {
    return test::kMonday + static_cast<std::int64_t>(days * 86400.0) * test::kSecond;
  };
  trend.alarms = {{"u", "y", true, day(3.0)},
                  {"v", "y", true, day(12.2)},
                  {"u", "y", false, day(12.2)},
                  {"u", "y", true, day(12.5)}};
  const Findings findings = find_changes(trend);
  REQUIRE(findings.changes.size() == 1);
  CHECK(findings.changes[0].alarm_ns == day(12.5));
}

TEST_CASE("what was wrong all along is told as an alarm, and the silent as silent") {
  Trend trend = test::sample_trend(
      96 * 10,
      [](int q, std::int64_t at) {
        Digest digest = test::sample_digest(at, 30.0, 0.1);
        digest.channels[0].alarm = "active";
        if (q < 96 * 8) return digest;
        digest.channels[0].gain_error = kUnknown;
        digest.channels[0].mismatch = 0;
        digest.channels[0].verdict = "undetermined";
        digest.channels[0].reason = "not_excited";
        return digest;
      },
      Step::kDay);
  Findings findings = find_changes(trend);
  CHECK(findings.changes.empty());
  REQUIRE(findings.standing.size() == 1);
  CHECK_FALSE(findings.standing[0].since_ns);
  trend.alarms = {{"u", "y", true, 5}, {"u", "y", true, 7}};
  CHECK(find_changes(trend).standing.at(0).since_ns == 7);
  REQUIRE(findings.silent.size() == 1);
  CHECK(findings.silent[0].last.reason == "not_excited");
  CHECK(findings.silent[0].since == 8);
}

TEST_CASE("a day that has just begun is no silence") {
  const auto of = [](int, std::int64_t at) { return test::sample_digest(at, 1.0, 0.1); };
  const Trend trend = test::sample_trend(96 * 10 + 2, of, Step::kDay);
  CHECK_FALSE(known(trend.periods.back().channels[0].gain_error));
  CHECK(find_changes(trend).silent.empty());
}

}  // namespace
}  // namespace mpm::history
