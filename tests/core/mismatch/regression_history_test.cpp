#include "core/mismatch/regression_history.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace mpm::regression_history_test {
namespace {

const double kNan = std::nan("");

std::vector<double> row_of(const RegressionHistory& history, const RegressionShape& shape, int age,
                           int cv = 0) {
  std::vector<double> row(static_cast<std::size_t>(shape.columns()));
  history.fill(cv, age, row.data());
  return row;
}

TEST_CASE("a row holds the lags of its own age") {
  const RegressionShape shape{1, 1, 3, 2, {0.5}};
  RegressionHistory history(shape, 10);
  Eigen::VectorXd u(1), e(1);
  for (int k = 0; k < 12; ++k) {
    u(0) = k;
    e(0) = 100 + k;
    history.push(u, e);
  }
  // Newest k = 11: 1, e(10), e(9), u(10..8), s(7); the first input value is the origin.
  double tail = 0.0;
  for (int k = 0; k <= 7; ++k) tail = 0.5 * tail + 0.5 * k;
  CHECK(row_of(history, shape, 0) == std::vector<double>{1, 110, 109, 10, 9, 8, tail});
  CHECK(history.residual(0, 0) == 111.0);
  CHECK(row_of(history, shape, 3)[1] == 107.0);
  CHECK(history.residual(0, 3) == 108.0);
  CHECK(history.usable(0));
}

TEST_CASE("means of a CV's own residuals stand beyond its lags") {
  RegressionShape shape{1, 2, 3, 2, {0.5}};
  shape.residual_poles = {0.5, 0.75};
  RegressionHistory history(shape, 20);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(1), e(2);
  // They begin with the first residual; what is unknown for two samples is interpolated in them,
  // too, and after a long gap they begin again with what comes first.
  double slow = 0.0, mean = 0.0;  // what the second CV's slower and faster one have been
  std::vector<double> slow_at, mean_at;
  for (int k = 0; k < 30; ++k) {
    const double value = std::sqrt(1.0 + k);
    const bool unknown = k == 8 || (k >= 15 && k < 19);
    e << 1.0, unknown ? kNan : value;
    history.push(u, e);
    const double between = 0.5 * (std::sqrt(8.0) + std::sqrt(10.0));
    if (k == 8) continue;
    const auto follow = [&](double to) {
      mean = 0.5 * mean + 0.5 * to;
      slow = 0.75 * slow + 0.25 * to;
      mean_at.push_back(mean);
      slow_at.push_back(slow);
    };
    if (k == 9) follow(between);
    if (k == 0 || k == 19) mean = slow = value;
    if (unknown) {
      mean_at.push_back(mean);
      slow_at.push_back(slow);
      continue;
    }
    follow(value);
  }
  for (const int age : {0, 5, 9, 12}) {
    const std::vector<double> row = row_of(history, shape, age, 1);
    const double* means = &row[static_cast<std::size_t>(shape.means_at())];
    const auto at = static_cast<std::size_t>(29 - age - 3);
    CAPTURE(age);
    CHECK(means[0] == Approx(mean_at[at]).epsilon(1e-14));
    CHECK(means[1] == Approx(slow_at[at]).epsilon(1e-14));
  }
  CHECK(shape.lead_in() == 1 + 2 * 2 + 2);
}

TEST_CASE("short unknown runs of a residual are interpolated, long ones cost their lags") {
  const RegressionShape shape{1, 1, 3, 3, {0.5}};
  RegressionHistory history(shape, 20);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(1), e(1);
  std::vector<bool> usable;
  for (int k = 0; k < 30; ++k) {
    const bool unknown = k == 10 || k == 11 || (k >= 20 && k < 23);
    e(0) = unknown ? kNan : k;
    history.push(u, e);
    usable.push_back(history.usable(0));
    if (k == 12) {
      CHECK(history.residual(0, 1) == Approx(11.0));
      CHECK(history.residual(0, 2) == Approx(10.0));
    }
  }
  CHECK(usable[9]);
  CHECK_FALSE(usable[10]);
  CHECK_FALSE(usable[11]);
  CHECK_FALSE(usable[12]);  // the residual just before was unknown
  CHECK(usable[13]);
  for (std::size_t k = 20; k <= 25; ++k) CHECK_FALSE(usable[k]);  // three lags after k = 22
  CHECK(usable[26]);
}

TEST_CASE("an unknown input counts as unchanged and costs no row") {
  const RegressionShape shape{1, 1, 2, 1, {0.5}};
  RegressionHistory history(shape, 10);
  Eigen::VectorXd u(1), e = Eigen::VectorXd::Zero(1);
  for (const double value : {0.0, 1.0, 2.0, 3.0, kNan, 5.0, 6.0}) {
    u(0) = value;
    history.push(u, e);
  }
  CHECK(history.usable(0));
  CHECK(row_of(history, shape, 0)[2] == 5.0);
  CHECK(row_of(history, shape, 0)[3] == 3.0);
}

TEST_CASE("after a gap the rows start anew") {
  const RegressionShape shape{1, 1, 2, 2, {0.5}};
  RegressionHistory history(shape, 10);
  Eigen::VectorXd u = Eigen::VectorXd::Ones(1), e = Eigen::VectorXd::Ones(1);
  for (int k = 0; k < 6; ++k) history.push(u, e);
  CHECK(history.usable(0));
  history.skip(1'000'000'000'000);  // bounded work whatever the gap
  history.push(u, e);
  CHECK_FALSE(history.usable(0));
  history.push(u, e);
  history.push(u, e);
  CHECK(history.usable(0));
}

}  // namespace
}  // namespace mpm::regression_history_test
