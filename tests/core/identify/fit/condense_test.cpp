#include "core/identify/fit/condense.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/identify/fit/calibration.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kMostRows = 40'000;

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// An input that is held for `hold` rows and a CV that answers it.
Recording held(Index rows, Index hold, double time_constant) {
  const VectorXd u = test::telegraph(3, rows, hold);
  return test::recording_of(u, test::first_order(u, 2.0, time_constant));
}

TEST_CASE("as many rows are averaged as the plant is slow, and no more than the recording needs") {
  const Index rows = 5 * kMostRows;
  Recording recording = test::recording_of(test::white(1, rows), MatrixXd::Zero(rows, 1));
  struct Case {
    PlantSpeed speed;
    Index expected;
  };
  // kSlowestSpanned slowest time constants in kMostRows rows, kRowsOfFastest rows in the fastest.
  const double one = static_cast<double>(kMostRows) / kSlowestSpanned;
  for (const Case& each : {Case{{50.0, one}, 1}, Case{{1e3, 3.0 * one}, 3}, Case{{1e4, 1e4}, 5},
                           Case{{2.5 * kRowsOfFastest, 1e4}, 2}, Case{{0.0, 0.0}, 1}}) {
    CAPTURE(each.speed.fastest_s, each.speed.slowest_s);
    CHECK(rows_to_average(recording, each.speed, kMostRows) == each.expected);
  }
  CHECK(rows_to_average(recording, kMostRows) == 5);
  recording.sample_time_s = 10.0;  // the same times are fewer rows
  CHECK(rows_to_average(recording, PlantSpeed{1e3, 3.0 * one}, kMostRows) == 1);
  CHECK(rows_to_average(part(recording, 0, kMostRows), PlantSpeed{1e9, 1e9}, kMostRows) == 1);
}

TEST_CASE("rows are averaged by control intervals where the inputs are held") {
  const Index rows = 5 * kMostRows;
  const auto every = [&](Index hold, PlantSpeed speed) {
    return rows_to_average(held(rows, hold, 30.0), speed, kMostRows);
  };
  CHECK(every(4, {1e4, 1e4}) == 8);  // wanted 5: two whole intervals
  CHECK(every(7, {1e4, 1e4}) == 7);
  CHECK(every(60, {40.0, 1e4}) == 5);  // longer than the plant allows: a part of one
  CHECK(every(63, {44.0, 1e4}) == 3);  // wanted 5, which is none
  CHECK(every(4, {50.0, 50.0}) == 4);  // nothing is lost by it
}

TEST_CASE(
    "a model whose numbers are not in seconds, or that bends its inputs, is not averaged for") {
  const Index rows = 5 * kMostRows;
  const Recording recording = test::recording_of(test::white(1, rows), MatrixXd::Zero(rows, 1));
  ModelSpec model = test::model_of({test::lag(0, 0, 1.0, 1e4)}, 1, 1);
  CHECK(rows_to_average(recording, model, kMostRows) == 5);
  model.input_blocks[0] = Deadband{0.5};
  CHECK(rows_to_average(recording, model, kMostRows) == 1);
  model.input_blocks[0].reset();
  model.channels[0].dynamics = DiscreteFilter{{0.1}, {1.0, -0.9}, 0};
  CHECK(rows_to_average(recording, model, kMostRows) == 1);
}

TEST_CASE(
    "averaged rows obey the same plant at the longer sample time, whatever row moves fall on") {
  // A lag behind a hold is the same difference equation at any multiple of the sample time, as long
  // as the input is held that long: y(K+1) = p^5 y(K) + gain (1 - p^5) u(K).
  const Index rows = 5 * kMostRows, hold = 5;
  for (const Index late : {Index{0}, Index{3}}) {
    CAPTURE(late);
    const Recording whole = held(rows + late, hold, 30.0);
    const Recording given = part(whole, late, rows);
    const Condensed condensed_data = condensed(given, hold, kMostRows);
    const Recording& data = condensed_data.recording;
    CHECK(data.sample_time_s == 5.0);
    CHECK(data.start_s == (late == 0 ? 0.0 : 5.0));
    CHECK(condensed_data.how.stretches == 0);
    CHECK(data.samples() == kMostRows - (late == 0 ? 0 : 1));
    const double pole = std::exp(-5.0 / 30.0);
    double largest = 0.0;
    for (Index k = 0; k + 1 < data.samples(); ++k)
      largest = std::max(largest, std::abs(data.cvs(k + 1, 0) - pole * data.cvs(k, 0) -
                                           2.0 * (1.0 - pole) * data.inputs(k, 0)));
    CHECK(largest < 1e-9);
  }
}

TEST_CASE("an averaged row takes what is known: the mean of an input, the last reading of a CV") {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  MatrixXd inputs(12, 1), cvs(12, 1);
  inputs << 1, 2, unknown, 5, unknown, unknown, unknown, unknown, 1, 3, 5, 7;
  cvs << 10, 11, 12, 13, unknown, 15, 16, 17, unknown, 19, 20, 21;
  cvs(3) = 13;
  Recording recording = test::recording_of(inputs, cvs);
  const Recording data = condensed(recording, 4, kMostRows).recording;
  REQUIRE(data.samples() == 3);
  CHECK(data.inputs(0, 0) == Approx(8.0 / 3.0));
  CHECK(std::isnan(data.inputs(1, 0)));
  CHECK(data.inputs(2, 0) == 4.0);
  CHECK(data.cvs(0, 0) == 10.0);
  CHECK(data.cvs(1, 0) == 13.0);  // of the row before
  CHECK(data.cvs(2, 0) == 17.0);
}

TEST_CASE("of what is still too long the stretches are taken in which most moves") {
  const Index rows = 8 * kMostRows, span = rows / kStretches, count = kMostRows / kStretches;
  VectorXd u = VectorXd::Zero(rows);
  for (Index s = 0; s < kStretches; ++s)  // moves in one place of each span
    u.segment(s * span + 10'000 + 100 * s, count) = test::telegraph(5, count + 20, 20).tail(count);
  const Recording given = test::recording_of(u, test::first_order(u, 1.0, 10.0));
  const Condensed some = condensed(given, 1, kMostRows);
  CHECK(some.how.given == rows);
  CHECK(some.how.stretches == kStretches);
  CHECK(some.recording.samples() == kMostRows);
  const std::vector<Run> runs = runs_of(some.recording);
  REQUIRE(runs.size() == static_cast<std::size_t>(kStretches));
  for (std::size_t s = 0; s < runs.size(); ++s) {
    const double at =
        on_clock(some.recording, some.recording.start_s + static_cast<double>(runs[s].first));
    const double moving = static_cast<double>(s) * static_cast<double>(span + 100) + 10'000.0;
    CHECK(std::abs(at - moving) < 100.0);
    CHECK(some.recording.inputs(runs[s].first + 500, 0) == u(static_cast<Index>(at) + 500));
  }
}

TEST_CASE("set-points choose the stretches, and not what disturbances and feedback do") {
  const Index rows = 8 * kMostRows, span = rows / kStretches;
  VectorXd setpoint = VectorXd::Zero(rows), disturbed = VectorXd::Zero(rows);
  for (Index s = 0; s < kStretches; ++s) {
    setpoint.segment(s * span + 10'000, 5'000) = test::telegraph(5, 5'020, 20).tail(5'000);
    disturbed.segment(s * span + 20'000, 5'000) = 100.0 * test::white(6, 5'000);
  }
  Recording given = test::recording_of(disturbed, disturbed);
  given.setpoints = setpoint;
  const Condensed some = condensed(given, 1, kMostRows);
  for (const Run& run : runs_of(some.recording))
    CHECK(some.recording.setpoints.middleRows(run.first, run.count).cwiseAbs().mean() > 0.9);
}

TEST_CASE("each run of a long recording keeps its share, and says which it is of") {
  const Index rows = 3 * kMostRows;
  const auto run = [&](Index count, double start_s) {
    Recording one = test::recording_of(test::white(2, count), test::white(3, count));
    one.start_s = start_s;
    return one;
  };
  const Condensed some =
      condensed(joined({run(rows, 0.0), run(rows / 3, 1e6), run(50, 2e6)}), 1, kMostRows);
  CHECK(some.recording.samples() <= kMostRows);
  CHECK(some.recording.samples() > kMostRows * 99 / 100);
  REQUIRE(some.run_of.size() == runs_of(some.recording).size());
  CHECK(some.run_of.front() == 0);
  CHECK(some.run_of.back() == 1);  // of the third so little is left that it says nothing
  CHECK(std::is_sorted(some.run_of.begin(), some.run_of.end()));
}

TEST_CASE("what is short enough is left alone") {
  const Recording given = held(kMostRows, 10, 30.0);
  const Condensed all = condensed(given, 1, kMostRows);
  CHECK_FALSE(all.how.any());
  CHECK(all.recording.cvs == given.cvs);
  CHECK(all.run_of == std::vector<std::size_t>{0});
}

TEST_CASE("rows are averaged from where each run says") {
  Recording recording =
      test::recording_of(VectorXd::LinSpaced(20, 0.0, 19.0), VectorXd::LinSpaced(20, 100.0, 119.0));
  recording.start_s = 50.0;
  recording.borders = {{10, 0.0}};
  const Recording every_third = averaged(recording, 3, {1, 2});
  CHECK(every_third.sample_time_s == 3.0);
  CHECK(every_third.start_s == 51.0);
  REQUIRE(every_third.samples() == 5);  // of rows 1 to 9 and 12 to 17
  REQUIRE(every_third.borders.size() == 1);
  CHECK(every_third.borders[0].row == 3);
  const double input[] = {2.0, 5.0, 8.0, 13.0, 16.0}, cv[] = {101.0, 104.0, 107.0, 112.0, 115.0};
  for (Index r = 0; r < 5; ++r) {
    CHECK(every_third.inputs(r, 0) == input[r]);
    CHECK(every_third.cvs(r, 0) == cv[r]);
  }
  CHECK(averaged(recording, 30, {0, 0}).samples() == 0);
}

}  // namespace
}  // namespace mpm
