#include "core/identify/fit/runs.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

Recording zeros(Index rows, double start_s) {
  Recording recording = test::recording_of(MatrixXd::Zero(rows, 1), MatrixXd::Zero(rows, 1));
  recording.start_s = start_s;
  return recording;
}

TEST_CASE("a run goes on across a gap of the slowest time constant, or of 20 intervals") {
  CHECK(longest_gap(test::model_of({test::lag(0, 0, 1.0, 5.0)}, 1, 1)) == 20);
  const ModelSpec slow =
      test::model_of({test::lag(0, 0, 1.0, 5.0), test::lag(1, 0, 1.0, 90.0)}, 1, 2);
  CHECK(std::abs(longest_gap(slow) - 90) <= 1);
}

TEST_CASE("rows in which an input was lost are left out, and a new run begins after them") {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  MatrixXd inputs = MatrixXd::Ones(200, 2), cvs = MatrixXd::Zero(200, 1);
  inputs.col(0).segment(30, 20).setConstant(unknown);   // not longer than it may be held
  inputs.col(1).segment(70, 21).setConstant(unknown);   // too long
  inputs.col(0).segment(120, 40).setConstant(unknown);  // a gap in all signals, and 20 rows more
  cvs.col(0).segment(120, 20).setConstant(unknown);
  Recording recording = test::recording_of(inputs, cvs);
  const Recording kept = without_lost_inputs(recording);
  CHECK(kept.samples() == 179);
  REQUIRE(kept.borders.size() == 1);
  CHECK(kept.borders[0].row == 70);
  CHECK(on_clock(kept, recording.start_s + 70.0 * recording.sample_time_s) ==
        recording.start_s + 91.0 * recording.sample_time_s);

  // Read once in thirty samples it is not lost, and never known it is for others to refuse.
  inputs.setConstant(unknown);
  for (Index k = 0; k < 200; k += 30) inputs(k, 0) = 1.0;
  recording = test::recording_of(inputs, cvs);
  CHECK(without_lost_inputs(recording).samples() == 200);
}

TEST_CASE("runs too short to tell anything are left out, where there are others") {
  const Recording kept =
      without_scraps(joined({zeros(39, 0.0), zeros(40, 100.0), zeros(90, 500.0)}));
  CHECK(kept.samples() == 130);
  CHECK(kept.start_s == 100.0);
  REQUIRE(kept.borders.size() == 1);
  CHECK(on_clock(kept, 140.0) == 500.0);
  CHECK(without_scraps(zeros(10, 0.0)).samples() == 10);
}

}  // namespace
}  // namespace mpm
