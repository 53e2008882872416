#include "core/performance/performance_meter.hpp"

#include <catch2/catch.hpp>

#include "core/monitor/calibration.hpp"
#include "tests/core/performance/made_unit.hpp"

namespace mpm {
namespace {

using test::kUnknown;
using test::made_frame;
using test::sine;

struct Meter {
  PerformanceMeter meter{test::made_setup()};
  PerformanceSums sums{test::made_setup()};

  void take(std::int64_t k, double u1, double u2, double y, double setpoint) {
    meter.take(made_frame(k, u1, u2, y, setpoint), sums);
  }
};

// A sine of amplitude a has the mean square a^2 / 2 over whole periods.
TEST_CASE("the control error is measured minus set-point, where both are known") {
  Meter made;
  int hole = 0;
  for (int k = 0; k < 400; ++k) {
    // One whole period is unknown, in either signal.
    const bool no_cv = k >= 100 && k < 120, no_setpoint = k >= 120 && k < 140;
    const double setpoint = k < 200 ? 10.0 : 20.0;
    hole += no_cv ? 1 : 0;
    made.take(k, k, k, no_cv ? kUnknown : setpoint + 0.25 + 2.0 * sine(k, 40.0),
              no_setpoint ? kUnknown : setpoint);
  }
  const CvSums& cv = made.sums.cvs[0];
  CHECK(made.sums.samples == 400);
  CHECK(cv.known == 400 - hole);
  CHECK(cv.error.count() == 360);
  CHECK(cv.error.mean() == Approx(0.25));
  CHECK(cv.error.variance() == Approx(2.0 * 360.0 / 359.0));
  CHECK(cv.error.rms() == Approx(std::sqrt(2.0 + 0.0625)));
}

TEST_CASE("bad quality does not count, and a CV without a set-point has no control error") {
  Meter made;
  Frame frame = made_frame(0, 1.0, 2.0, 0.0, kUnknown);
  made.meter.take(frame, made.sums);
  frame = made_frame(1, 1.0, 2.0, 50.0, 0.0);
  frame[SignalKind::kCv].quality[0] = Quality::kBad;
  frame[SignalKind::kMv].quality[0] = Quality::kBad;
  made.meter.take(frame, made.sums);
  CHECK(made.sums.cvs[0].known == 1);
  CHECK(made.sums.cvs[0].outside == 0);
  CHECK(made.sums.cvs[0].error.count() == 0);
  CHECK(made.sums.mvs[0].known == 1);
  CHECK(made.sums.mvs[1].known == 2);
}

// Within 0.5 of 0 or 100, for the range is 100 wide; the CV is outside only beyond its limits.
TEST_CASE("shares at limits and outside them") {
  Meter made;
  int k = 0;
  for (const double u : {-1.0, 0.0, 0.5, 0.6, 50.0, 99.4, 99.5, 100.0, 101.0})
    made.take(k++, u, u, 0.0, 0.0);
  for (const double y : {-0.51, -0.5, 0.0, 1.0, 1.01, 2.0}) made.take(k++, 50.0, 50.0, y, 0.0);
  CHECK(made.sums.mvs[0].at_low == 3);
  CHECK(made.sums.mvs[0].at_high == 3);
  CHECK(made.sums.mvs[0].at_limits == 6);
  CHECK(made.sums.mvs[1].at_limits == 0);  // it has none
  CHECK(made.sums.cvs[0].outside == 3);
}

TEST_CASE("with one limit alone a value is at it from there on") {
  const SignalLimits low{10.0, {}};
  CHECK(low.at_low(10.0));
  CHECK(low.at_low(9.0));
  CHECK_FALSE(low.at_low(10.000001));
  CHECK_FALSE(low.at_high(1e9));
  CHECK_FALSE(low.outside(10.0));
}

TEST_CASE("travel is the mean move between values one sample apart") {
  Meter made;
  // Moves of 2 and 3; after the unknown one and after the gap none is known.
  made.take(0, 1.0, 0.0, 0.0, 0.0);
  made.take(1, 3.0, 0.0, 0.0, 0.0);
  made.take(2, kUnknown, 0.0, 0.0, 0.0);
  made.take(3, 50.0, 0.0, 0.0, 0.0);
  made.take(4, 47.0, 0.0, 0.0, 0.0);
  made.take(9, 0.0, 0.0, 0.0, 0.0);
  CHECK(made.sums.mvs[0].moves == 2);
  CHECK(made.sums.mvs[0].travel == 5.0);
  CHECK(made.sums.mvs[1].moves == 4);
  made.meter.begin_run();
  made.take(10, 5.0, 5.0, 0.0, 0.0);
  CHECK(made.sums.mvs[0].moves == 2);
}

// An MV stands from the 61st equal value on: 60 repetitions (calibration::input_motion).
TEST_CASE("an MV that keeps its value stands, and where all stand the controller does not act") {
  constexpr int kStill = calibration::input_motion::kStillSamples;
  Meter made;
  for (int k = 0; k < 300; ++k) made.take(k, k < 100 ? k : 100.0, k < 200 ? k : 200.0, 0.0, 0.0);
  CHECK(made.sums.mvs[0].standing == 200 - kStill);
  CHECK(made.sums.mvs[1].standing == 100 - kStill);
  CHECK(made.sums.told == 300);
  CHECK(made.sums.acting == 200 + kStill);
  // One rests and the other is unknown: nobody can tell. It moves while the other is unknown: it
  // does.
  made.take(300, 100.0, kUnknown, 0.0, 0.0);
  made.take(301, 101.0, kUnknown, 0.0, 0.0);
  CHECK(made.sums.told == 301);
  CHECK(made.sums.acting == 201 + kStill);
}

TEST_CASE("of nothing no share is told") {
  CHECK(std::isnan(share_of(0, 0)));
  CHECK(share_of(1, 4) == 0.25);
}

}  // namespace
}  // namespace mpm
