#include "daemon/history/trend/trend_words.hpp"

#include <catch2/catch.hpp>

#include "tests/daemon/history/sample_history.hpp"

namespace mpm::history {

TEST_CASE("what changed is said in a sentence") {
  const Trend trend = test::changing_trend(30, 12, -20.0, 0.25);
  const report::MomentText moment(trend.periods.back().until_ns, 60.0, nullptr);
  Change gain{"u", "y", false, 12, {}, 0.4, 41.2, 31.4, 50.9, 1.0, 1e-9};
  CHECK(words_of(trend, gain, moment) ==
        "u -> y: gain +41 % (31 to 51) since 17 January; was within 5 % before");
  gain.before = -12.3;
  gain.alarm_ns = test::kMonday + 14 * 3600 * test::kSecond;
  CHECK(words_of(trend, gain, moment) ==
        "u -> y: gain +41 % (31 to 51) since 14:00 on 5 January; was -12 % before");
  gain.gradual = true;
  gain.alarm_ns.reset();
  CHECK(words_of(trend, gain, moment) ==
        "u -> y: gain +41 % (31 to 51), gradually since 17 January; was -12 % before");

  Change errors{"", "y", false, 12, {}, 1.0, 2.13, 1.84, 2.46, 1.1, 1e-9};
  CHECK(words_of(trend, errors, moment) ==
        "y: prediction errors 2.1 times as large (1.8 to 2.5) since 17 January");
  errors.movement_ratio = 1.9;
  CHECK(words_of(trend, errors, moment) ==
        "y: prediction errors 2.1 times as large (1.8 to 2.5) since 17 January; it moved 1.9 times "
        "as much");
}

TEST_CASE("alarms and silence are said in a sentence, and what no sentence can be") {
  const Trend trend = test::changing_trend(5, 2, -20.0, 0.25);
  const report::MomentText moment(trend.periods.back().until_ns, 60.0, nullptr);
  CHECK(words_of(trend, Standing{"u", "y", test::kMonday, 41.2, 31.4, 50.9}, moment) ==
        "u -> y: gain +41 % (31 to 51), in alarm since 00:00 on 5 January");
  CHECK(words_of(trend, Standing{"u", "y", {}, kUnknown, kUnknown, kUnknown}, moment) ==
        "u -> y: gain not known, in alarm since before these data begin");
  Silence silence;
  silence.last = trend.last[0];
  silence.last.verdict = "undetermined";
  silence.last.reason = "collinear";
  silence.last.confounder = "v";
  CHECK(words_of(trend, silence) ==
        "u -> y: moved only together with v; move one without the other");
  silence.since = 3;
  CHECK(words_of(trend, silence) ==
        "u -> y: nothing since 8 January; moved only together with v; move one without the other");
  silence.last.reason = "not_excited";
  silence.last.smallest_error = 0.28;
  CHECK(words_of(trend, silence) ==
        "u -> y: nothing since 8 January; needs a gain error of 28 % to show; move u");
  Trend disturbed = trend;
  disturbed.head.channels[0].disturbance = true;
  CHECK(words_of(disturbed, silence) ==
        "u -> y: nothing since 8 January; needs a gain error of 28 % to show; wait until u moves");
  CHECK(words_of_rate(trend, find_changes(trend)) ==
        "Changes cannot be told: no series has 6 days that are known.");
  CHECK(words_of_rate(trend, Findings{{}, {}, {}, 4}) ==
        "No change beyond what chance gives: of a history without changes any is told in less than "
        "1 % of cases.");
}

}  // namespace mpm::history
