#include "core/mismatch/residual_regression.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "tests/core/counter_noise.hpp"

namespace mpm::residual_regression_test {
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

// Expected: noise uniform in +-0.1 has s.d. 0.0577; weighed by it a row has 17, and one that is 87
// of them away 3 / 87 of that.
TEST_CASE("a wild row right after a fresh start spoils nothing of what comes after it") {
  const RegressionShape shape{1, 1, 30, 4, {0.5}};
  RegressionHistory history(shape, 2000);
  ResidualRegression regression(shape, 0, {{0.999, 0}}, 2000);
  RowWorkspace work(shape.columns(), 8);
  Eigen::VectorXd u(1), e(1);
  double before = 0.0;
  for (int k = 0; k < 1500; ++k) {
    u(0) = test::coloured(1, k);
    e(0) = 0.5 * before + 0.1 * test::uniform(2, k) + (k == 1003 ? 5.0 : 0.0);
    before = u(0);
    history.push(u, e);
    regression.add_sample(history, work);
    if (k == 1020) regression.start_afresh(21, history, work);
  }
  regression.fold(history, work);
  CHECK(regression.noise().scale() == Approx(0.0577).epsilon(0.15));
  CHECK(regression.noise().clipped_share() < 0.02);
  const int wild = 1499 - 1003;
  CHECK(regression.row_weight(wild) < 1.5);
  CHECK(regression.row_weight(wild + 1) > 10.0);
  CHECK(regression.row_weight(wild - 40) > 10.0);
}

TEST_CASE("a fresh start on data without noise keeps its weights finite") {
  Run run({{1.0, 0}}, 2000, 8);
  Eigen::VectorXd u(1), e(1);
  double before = 0.0;
  for (int k = 0; k < 600; ++k) {
    u(0) = test::coloured(1, k);
    e(0) = 0.5 * before + (k < 400 ? 0.1 * test::uniform(2, k) : 0.0);
    before = u(0);
    run.history.push(u, e);
    run.regression.add_sample(run.history, run.work);
    if (k == 500) run.regression.start_afresh(90, run.history, run.work);
  }
  run.regression.fold(run.history, run.work);
  CHECK(run.regression.noise().scale() > 0.0);
  for (int age = 0; age < 190; ++age) {
    CHECK(run.regression.row_weight(age) > 0.0);
    CHECK(std::isfinite(run.regression.row_weight(age)));
  }
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
}  // namespace mpm::residual_regression_test
