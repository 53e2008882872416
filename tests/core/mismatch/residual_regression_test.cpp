#include "core/mismatch/residual_regression.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "tests/core/counter_noise.hpp"

namespace mpm {
namespace {

const RegressionShape kShape{1, 1, 2, 1, {0.5}};  // 5 columns

struct Run {
  Run(const std::vector<MemoryLength>& lengths, int remembered, int patience)
      : history(kShape, remembered),
        regression(kShape, 0, lengths, remembered),
        work(kShape.columns(), patience) {}
  void sample(int k) {
    Eigen::VectorXd u(1), e(1);
    u(0) = test::coloured(1, k);
    e(0) = test::uniform(2, k);
    history.push(u, e);
    regression.add_sample(history, work);
  }
  RegressionHistory history;
  ResidualRegression regression;
  RowWorkspace work;
};

TEST_CASE("rows wait once there are ten per column, and are taken when asked for") {
  Run run({{1.0, 0}}, 500, 8);
  int k = 0;
  while (run.regression.memory(0).rows < 10 * kShape.columns()) run.sample(k++);
  const int before = run.regression.memory(0).rows;
  for (int more = 0; more < 5; ++more) run.sample(k++);
  CHECK(run.regression.memory(0).rows == before);
  CHECK(run.regression.row_weight(0) < 0.0);
  run.regression.fold(run.history, run.work);
  CHECK(run.regression.memory(0).rows == before + 5);
  CHECK(run.regression.row_weight(0) > 0.0);
}

TEST_CASE("the means of the own past are taken in from fifteen rows per column on") {
  RegressionShape shape = kShape;
  shape.residual_poles = {0.9};
  RegressionHistory history(shape, 500);
  ResidualRegression regression(shape, 0, {{1.0, 0}}, 500);
  RowWorkspace work(shape.columns(), 1);
  const auto sample = [&](int k) {
    Eigen::VectorXd u(1), e(1);
    u(0) = test::coloured(1, k);
    e(0) = test::uniform(2, k);  // white: nothing to take them in for before
    history.push(u, e);
    regression.add_sample(history, work);
  };
  const auto mean = [&] {
    std::vector<double> row(static_cast<std::size_t>(shape.columns()));
    regression.fill(history, 0, row.data());
    return row[static_cast<std::size_t>(shape.means_at())];
  };
  int k = 0;
  for (; regression.memory(0).rows < 14 * shape.columns(); ++k) sample(k);
  CHECK_FALSE(regression.take_means_in(history, work));
  CHECK(mean() == 0.0);
  for (; regression.memory(0).rows < 15 * shape.columns(); ++k) sample(k);
  const int rows = regression.memory(0).rows;
  CHECK(regression.take_means_in(history, work));
  CHECK(mean() != 0.0);
  CHECK(regression.memory(0).rows == rows);
  CHECK_FALSE(regression.take_means_in(history, work));
  // On few rows it does without them again.
  regression.start_afresh(5 * shape.columns(), history, work);
  CHECK(mean() == 0.0);
}

TEST_CASE("slow noise is seen on fewer rows, and asks for more") {
  RegressionShape shape{1, 1, 20, 1, {0.5}};  // 24 columns
  shape.residual_poles = {0.9};
  RegressionHistory history(shape, 500);
  ResidualRegression regression(shape, 0, {{1.0, 0}}, 500);
  RowWorkspace work(shape.columns(), 1);
  double walk = 0.0;
  for (int k = 0; regression.memory(0).rows < 14 * shape.columns(); ++k) {
    Eigen::VectorXd u(1), e(1);
    u(0) = test::coloured(1, k);
    walk += test::uniform(3, k);
    e(0) = walk + 3.0 * test::uniform(2, k);
    history.push(u, e);
    regression.add_sample(history, work);
  }
  CHECK(regression.memory(0).needed_rows() < 10 * shape.columns());
  CHECK(regression.take_means_in(history, work));
  CHECK(regression.memory(0).needed_rows() >= 15 * shape.columns());
}

TEST_CASE("a sliding window holds what it says") {
  // It is rebuilt each time it has grown by an eighth: never more than 100 + 12 rows, and every
  // sample gives one.
  Run run({{1.0, 0}, {1.0, 100}}, 500, 1);
  for (int k = 0; k < 450; ++k) {
    run.sample(k);
    if (k < 200) continue;
    CHECK(run.regression.memory(1).rows >= 100);
    CHECK(run.regression.memory(1).rows < 100 + 100 / 8 + 1);
  }
  CHECK(run.regression.memory(0).rows > 400);
}

TEST_CASE("a fresh start rests on the last samples alone") {
  Run run({{1.0, 0}, {0.99, 0}}, 500, 8);
  for (int k = 0; k < 300; ++k) run.sample(k);
  run.regression.start_afresh(60, run.history, run.work);
  CHECK(run.regression.span() == 60);
  CHECK(run.regression.memory(0).rows == 60);
  CHECK(run.regression.memory(1).rows == 60);
  run.regression.start_afresh(0, run.history, run.work);
  CHECK(run.regression.memory(0).rows == 0);
  run.sample(300);
  CHECK(run.regression.memory(0).rows == 1);
}

TEST_CASE("gaps have no rows") {
  Run run({{1.0, 0}}, 500, 8);
  for (int k = 0; k < 100; ++k) run.sample(k);
  run.regression.fold(run.history, run.work);
  const int before = run.regression.memory(0).rows;
  run.history.skip(3);
  run.regression.add_gap(3);
  for (int age = 0; age < 3; ++age) CHECK(run.regression.row_weight(age) == 0.0);
  CHECK(run.regression.memory(0).rows == before);
}

TEST_CASE("impossible memories are refused") {
  CHECK_THROWS_AS(Run({}, 100, 1), std::invalid_argument);
  CHECK_THROWS_AS(Run({{1.5, 0}}, 100, 1), std::invalid_argument);
  CHECK_THROWS_AS(Run({{1.0, 100}}, 100, 1), std::invalid_argument);
}

}  // namespace
}  // namespace mpm
