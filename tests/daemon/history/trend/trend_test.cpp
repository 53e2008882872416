#include "daemon/history/trend/trend.hpp"

#include <catch2/catch.hpp>

#include "tests/daemon/history/sample_history.hpp"

namespace mpm::history {
namespace {

using test::sample_digest;
using test::sample_trend;

TEST_CASE("a period has the shares, means and mean squares of its digests") {
  const Trend trend = sample_trend(
      96 * 2,
      [](int q, std::int64_t at) {
        Digest digest = sample_digest(at, q % 2 == 0 ? 2.0 : 8.0, q < 96 ? 0.3 : 0.4);
        if (q % 4 == 3) {  // a quarter of the time nothing is known
          digest.channels[0].match = digest.channels[0].mismatch = 0;
          digest.channels[0].gain_error = kUnknown;
        }
        return digest;
      },
      Step::kDay);
  REQUIRE(trend.periods.size() == 2);
  CHECK(trend.samples() == 2 * 1440);
  CHECK(trend.dated);
  CHECK(period_name(trend, 0) == "5 January");
  const Period& day = trend.periods[0];
  CHECK(day.samples == 1440);
  CHECK(day.from_ns == test::kMonday);
  const ChannelPeriod& channel = day.channels.at(0);
  CHECK(channel.match == 0.5);
  CHECK(channel.mismatch == 0.25);
  CHECK(channel.undetermined == 0.25);
  CHECK(channel.gain_error == Approx((2.0 * 2.0 + 8.0) / 3.0));
  CHECK(channel.high - channel.low == Approx(4.0));
  // 1080 samples of estimates that rest on 400 each.
  CHECK(channel.deviation == Approx(2.0 / 1.96 / std::sqrt(1080.0 / 400.0)));
  CHECK(day.cvs.at(0).prediction_rms == Approx(0.3));
  CHECK(trend.periods[1].cvs[0].prediction_rms == Approx(0.4));
  CHECK(day.cvs[0].fit() == Approx(100.0 * (1.0 - 0.3 / 4.0)));
}

// Var of the squares 1 and 9 with mean 5 is 16: d ln rms = 0.5 d(square) / square.
TEST_CASE("how well prediction errors are known is told by how they scatter") {
  const Trend trend = sample_trend(
      96, [](int q, std::int64_t at) { return sample_digest(at, 0.0, q % 2 == 0 ? 1.0 : 3.0); },
      Step::kDay);
  const double apart = 2.0 * 10.0 + 15.0;  // horizon and digest, samples
  CHECK(trend.periods[0].cvs[0].deviation == Approx(0.5 * std::sqrt(16.0 * apart / 1440.0) / 5.0));
}

TEST_CASE("a period of which too little is known is shown as not known, never as good") {
  const auto shown = [](int quarters_known) {
    const Trend trend = sample_trend(
        96,
        [=](int q, std::int64_t at) {
          Digest digest = sample_digest(at, 1.0, 0.3);
          if (q < quarters_known) return digest;
          digest.cvs[0] = {"y", 0, kUnknown, 0, kUnknown, kUnknown};
          digest.channels[0].gain_error = kUnknown;
          digest.channels[0].match = 0;
          return digest;
        },
        Step::kDay);
    const Period& day = trend.periods.at(0);
    CHECK(known(day.cvs[0].prediction_rms) == known(day.channels[0].gain_error));
    return known(day.cvs[0].prediction_rms);
  };
  CHECK(shown(10));  // a tenth of the day is 9.6 quarters of an hour
  CHECK_FALSE(shown(9));
  CHECK_FALSE(shown(0));
}

TEST_CASE("periods are hours, days or weeks by the length of the history") {
  const auto step_of = [](int days) {
    return sample_trend(96 * days, [](int, std::int64_t at) { return sample_digest(at, 0.0, 0.1); })
        .step;
  };
  CHECK(step_of(2) == Step::kHour);
  CHECK(step_of(3) == Step::kDay);
  CHECK(step_of(60) == Step::kDay);
  CHECK(step_of(61) == Step::kWeek);
}

TEST_CASE("weeks begin on Monday and days at midnight, where the data are") {
  const auto of = [](int, std::int64_t at) { return sample_digest(at, 0.0, 0.1); };
  const Trend weeks = sample_trend(96 * 15, of, Step::kWeek);  // two weeks and a Monday
  REQUIRE(weeks.periods.size() == 3);
  CHECK(weeks.periods[0].samples == 7 * 1440);
  CHECK(weeks.periods[2].samples == 1440);
  CHECK(period_name(weeks, 1) == "week 3 (from 12 January)");

  const files::TimeZone kolkata("Asia/Kolkata");  // 05:30 east
  const Trend days = sample_trend(96 * 2, of, Step::kDay, &kolkata);
  REQUIRE(days.periods.size() == 3);
  CHECK(days.periods[0].samples == 1440 - 5 * 60 - 30);
  CHECK(period_name(sample_trend(96, of, Step::kHour, &kolkata), 1) == "06:00 on 5 January");
}

TEST_CASE("a year is named where it is not the last one, and seconds of a run have no dates") {
  TrendMaker maker(Step::kDay, nullptr);
  maker.add(test::sample_head());
  for (const std::int64_t day : {-10, 0}) {
    Digest digest = sample_digest(test::kMonday + day * 86400 * test::kSecond, 0.0, 0.1);
    maker.add(digest);
  }
  CHECK(period_name(maker.finish(), 0) == "26 December 2025");

  TrendMaker run(Step::kHour, nullptr);
  run.add(test::sample_head());
  for (const std::int64_t hour : {0, 2})
    run.add(sample_digest(hour * 3600 * test::kSecond, 0, 0.1));
  const Trend trend = run.finish();
  CHECK_FALSE(trend.dated);
  CHECK(period_name(trend, 0) == "hour 1");
  CHECK(period_name(trend, 1) == "hour 3");
}

TEST_CASE("what is told twice counts once") {
  const Trend trend = sample_trend(
      96 * 2,
      [](int q, std::int64_t) {
        return sample_digest(test::kMonday + (q % 96) * 900 * test::kSecond, 1.0, 0.3);
      },
      Step::kDay);
  REQUIRE(trend.periods.size() == 1);
  CHECK(trend.samples() == 1440);
}

TEST_CASE("an hour that comes twice, for the clock was set back, counts twice") {
  const Trend trend = sample_trend(
      8,
      [](int q, std::int64_t) {
        return sample_digest(test::kMonday + (q % 4) * 900 * test::kSecond, 1.0, q < 4 ? 0.3 : 0.4);
      },
      Step::kHour);
  REQUIRE(trend.periods.size() == 1);
  CHECK(trend.samples() == 120);
}

TEST_CASE("of nothing there is no trend") {
  TrendMaker maker(std::nullopt, nullptr);
  maker.add(test::sample_head());
  CHECK(maker.finish().periods.empty());
}

}  // namespace
}  // namespace mpm::history
