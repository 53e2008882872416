#include "core/identify/evidence/jumps.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::jumps_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kRows = 400;

Recording sound() {
  MatrixXd u(kRows, 2);
  u << test::telegraph(1, kRows, 12), test::telegraph(2, kRows, 9);
  MatrixXd y(kRows, 1);
  y = test::first_order(u.col(0), 2.0, 10.0) + 0.05 * test::white(3, kRows);
  return test::recording_of(u, y);
}

Index unknown(const MatrixXd& values) { return values.size() - values.array().isFinite().count(); }

}  // namespace

TEST_CASE("of a sound recording nothing is left out, steps and rests of inputs least of all") {
  Recording recording = sound();
  recording.inputs.col(1).segment(100, 150).setConstant(0.5);
  const Recording before = recording;
  CHECK(leave_out_jumps(recording).total() == 0);
  CHECK(recording.inputs == before.inputs);
  CHECK(recording.cvs == before.cvs);
}

TEST_CASE("one wild value of any signal is left out, wherever it is, and no other") {
  for (const double wild : {90.0, -1e4, 1e20, 1e99})
    for (const Index row : {Index{2}, Index{45}, Index{200}, kRows - 2}) {
      CAPTURE(wild, row);
      Recording of_input = sound(), of_cv = sound();
      of_input.inputs(row, 1) = wild;
      of_cv.cvs(row, 0) = wild;
      const JumpTally inputs = leave_out_jumps(of_input), cvs = leave_out_jumps(of_cv);
      CHECK(inputs.inputs == std::vector<Index>{0, 1});
      CHECK(inputs.cvs == std::vector<Index>{0});
      CHECK(std::isnan(of_input.inputs(row, 1)));
      CHECK(unknown(of_input.inputs) == 1);
      CHECK(cvs.cvs == std::vector<Index>{1});
      CHECK(std::isnan(of_cv.cvs(row, 0)));
      CHECK(unknown(of_cv.cvs) == 1);
    }
}

// A historian's or an instrument's: causes are told by them.
TEST_CASE("a signal that is in another unit for a while is left out there, a test's pulse is not") {
  for (const Index row : {Index{0}, Index{200}}) {
    Recording recording = sound();
    recording.inputs.col(1).segment(row, 30).array() =
        1e6 * (20.0 + recording.inputs.col(1).segment(row, 30).array());
    recording.cvs.col(0).segment(row, 35) *= 1e9;
    const JumpTally left_out = leave_out_jumps(recording);
    CHECK(left_out.inputs == std::vector<Index>{0, 30});
    CHECK(left_out.cvs[0] >= 30);  // some were hardly anything
    CHECK(recording.cvs.col(0)
              .array()
              .isFinite()
              .select(recording.cvs.col(0).array(), 0.0)
              .abs()
              .maxCoeff() < 1e6);
  }
  Recording tested = sound();
  tested.inputs.col(1) = 1e-3 * test::white(7, kRows);
  tested.inputs.col(1).segment(150, 30).setConstant(20.0);
  CHECK(leave_out_jumps(tested).total() == 0);
}

TEST_CASE("values that stand still, or rest at the end of a range, stay") {
  Recording recording = sound();
  recording.cvs.col(0) = recording.cvs.col(0).cwiseMin(1.0);
  recording.cvs.col(0).segment(300, 40).setConstant(recording.cvs(300, 0));
  CHECK(leave_out_jumps(recording).total() == 0);
}

// By more than six times its usual steps.
TEST_CASE("pulses within what a fast process does stay") {
  Recording recording = sound();
  for (Index k = 20; k < kRows; k += 37) recording.cvs(k, 0) += 3.0;
  CHECK(leave_out_jumps(recording).total() == 0);
}

TEST_CASE("a level that is another one after a border is no jump, nor is a step that stays") {
  Recording recording = sound();
  recording.borders.push_back({200, 0.0});
  recording.cvs.col(0).tail(200).array() += 1000.0;
  const Recording before = recording;
  CHECK(leave_out_jumps(recording).total() == 0);
  for (Index k = 0; k < kRows; ++k)
    if (std::isnan(recording.cvs(k, 0))) UNSCOPED_INFO("row " << k << " " << before.cvs(k, 0));
  CHECK(unknown(recording.cvs) == 0);
  Recording step = sound();
  step.inputs.col(0).tail(200).array() += 40.0;
  CHECK(leave_out_jumps(step).total() == 0);
}

TEST_CASE("pulses of a test stay, whatever the input did before; a wild stretch does not") {
  Recording pulses = sound();
  pulses.inputs.col(0).setZero();
  for (const Index at : {Index{10}, Index{100}, Index{250}})
    pulses.inputs.col(0).segment(at, 4).setConstant(1.0);
  pulses.inputs.col(1) = 0.01 * test::white(9, kRows);
  pulses.inputs.col(1).segment(300, 5).setConstant(2.0);
  CHECK(leave_out_jumps(pulses).total() == 0);
  Recording single = sound();  // rests but for one row
  single.inputs.col(0).setZero();
  single.inputs(200, 0) = 1.0;
  CHECK(leave_out_jumps(single).total() == 0);
  Recording wild = sound();
  wild.cvs.col(0).segment(120, 6).setConstant(1e12);
  CHECK(leave_out_jumps(wild).cvs == std::vector<Index>{6});
}

}  // namespace mpm::jumps_test
