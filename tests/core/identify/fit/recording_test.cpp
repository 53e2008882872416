#include "core/identify/fit/recording.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::recording_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rows begin, begin + 1, ... as inputs and CVs.
Recording counted(double start_s, Index begin, Index rows) {
  const VectorXd values =
      VectorXd::LinSpaced(rows, static_cast<double>(begin), static_cast<double>(begin + rows - 1));
  Recording recording = test::recording_of(values, values);
  recording.start_s = start_s;
  return recording;
}

/// 0..9 at 100 s, 10..14 at 500 s, 15..17 at 20 s.
Recording three() {
  return joined({counted(100.0, 0, 10), counted(500.0, 10, 5), counted(20.0, 15, 3)});
}

TEST_CASE("a recording is one run unless it has borders") {
  const std::vector<Run> one = runs_of(counted(0.0, 0, 7));
  REQUIRE(one.size() == 1);
  CHECK(one[0].first == 0);
  CHECK(one[0].count == 7);
  const std::vector<Run> runs = runs_of(three());
  REQUIRE(runs.size() == 3);
  CHECK(runs[1].first == 10);
  CHECK(runs[1].count == 5);
  CHECK(runs[2].first == 15);
  CHECK(runs[2].count == 3);
}

TEST_CASE("recordings follow each other row by row, each on its own clock") {
  const Recording all = three();
  CHECK(all.start_s == 100.0);
  CHECK(all.inputs == VectorXd::LinSpaced(18, 0.0, 17.0));
  CHECK(all.cvs == all.inputs);
  const auto moment = [&](Index row) { return on_clock(all, 100.0 + static_cast<double>(row)); };
  CHECK(moment(0) == 100.0);
  CHECK(moment(9) == 109.0);
  CHECK(moment(10) == 500.0);
  CHECK(moment(14) == 504.0);
  CHECK(moment(15) == 20.0);
  CHECK(moment(17) == 22.0);
  CHECK(on_clock(counted(7.0, 0, 3), 8.5) == 8.5);
}

TEST_CASE("a part keeps the borders inside it and the clock of its rows") {
  const Recording all = three();
  const Recording middle = part(all, 12, 5);
  CHECK(middle.start_s == 502.0);
  CHECK(middle.inputs == VectorXd::LinSpaced(5, 12.0, 16.0));
  REQUIRE(middle.borders.size() == 1);
  CHECK(middle.borders[0].row == 3);
  CHECK(on_clock(middle, middle.start_s + 3.0) == 20.0);
  CHECK(part(all, 0, 10).borders.empty());
  CHECK(part(all, 10, 5).start_s == 500.0);
  CHECK(part(all, 10, 5).borders.empty());
}

TEST_CASE("recordings that have runs keep them when they are joined") {
  const Recording all = joined({counted(0.0, 18, 4), three()});
  REQUIRE(all.borders.size() == 3);
  CHECK(all.borders[1].row == 14);
  CHECK(on_clock(all, 14.0) == 500.0);
  CHECK(on_clock(all, 19.0) == 20.0);
}

}  // namespace
}  // namespace mpm::recording_test
