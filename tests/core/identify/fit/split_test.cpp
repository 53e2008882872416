#include "core/identify/fit/split.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

Recording of_lengths(const std::vector<Index>& lengths) {
  std::vector<Recording> runs;
  runs.reserve(lengths.size());
  for (const Index rows : lengths)
    runs.push_back(test::recording_of(MatrixXd::Zero(rows, 1), MatrixXd::Zero(rows, 1)));
  return joined(runs);
}

TEST_CASE("one run or two are cut at the share of the rows") {
  CHECK(fitted_rows(of_lengths({1000}), 2.0 / 3) == 666);
  CHECK(fitted_rows(of_lengths({500, 500}), 2.0 / 3) == 666);
  CHECK(fitted_rows(of_lengths({500, 500}), 0.25) == 250);
  // What came after a change is parted by that share, if it is in the part that is fitted, or no
  // more than 3 % of that behind it.
  Recording changed = of_lengths({1000});
  changed.changed = 400;
  CHECK(fitted_rows(changed, 2.0 / 3) == 800);
  changed.changed = 680;
  CHECK(fitted_rows(changed, 2.0 / 3) == 893);
  changed.changed = 700;
  CHECK(fitted_rows(changed, 2.0 / 3) == 666);
}

TEST_CASE("of three runs and more the last are left out whole") {
  CHECK(fitted_rows(of_lengths({300, 300, 300}), 2.0 / 3) == 600);
  CHECK(fitted_rows(of_lengths({200, 350, 450}), 2.0 / 3) == 550);
  CHECK(fitted_rows(of_lengths({100, 100, 100, 100, 100, 100, 100}), 2.0 / 3) == 500);
}

TEST_CASE("runs too unlike in length are cut as one would be") {
  CHECK(fitted_rows(of_lengths({50, 50, 900}), 2.0 / 3) == 666);
  CHECK(fitted_rows(of_lengths({900, 50, 50}), 2.0 / 3) == 666);
}

}  // namespace
}  // namespace mpm
