#include "core/identify/fit/runs.hpp"

#include <catch2/catch.hpp>
#include <cmath>

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
