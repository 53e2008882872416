#include "core/statistics/readback.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/core/counter_noise.hpp"

namespace mpm::readback_test {
namespace {

constexpr int kRows = 600;

// What a controller sends: moves each few samples.
Eigen::MatrixXd commands() {
  Eigen::MatrixXd inputs(kRows, 2);
  for (int k = 0; k < kRows; ++k)
    for (int i = 0; i < 2; ++i)
      inputs(k, i) = 50.0 + test::uniform(static_cast<std::uint64_t>(i), k / (3 + i));
  return inputs;
}

// A loop below: 60 % of the way each sample, with measurement noise of `noise`.
Eigen::VectorXd flow_behind(const Eigen::VectorXd& command, double noise) {
  Eigen::VectorXd flow(kRows);
  double value = command(0);
  for (int k = 0; k < kRows; ++k) {
    flow(k) = value + noise * test::uniform(10, k);
    value += 0.6 * (command(k) - value);
  }
  return flow;
}

}  // namespace

TEST_CASE("a measured flow reads its set-point back, through noise and gaps") {
  const Eigen::MatrixXd inputs = commands();
  for (const double noise : {0.0, 0.05, 0.1}) {
    Eigen::VectorXd flow = flow_behind(inputs.col(1), noise);
    CAPTURE(noise);
    CHECK(reads_back(inputs, flow));
    flow.segment(100, 20).setConstant(std::numeric_limits<double>::quiet_NaN());
    CHECK(reads_back(inputs, flow));
  }
  CHECK_FALSE(reads_back(inputs, flow_behind(inputs.col(1), 1.0)));  // noise twice its movement
}

TEST_CASE("what moves by itself is no readback, though an input follows it") {
  Eigen::MatrixXd inputs = commands();
  Eigen::VectorXd ambient(kRows);
  double value = 0.0;
  for (int k = 0; k < kRows; ++k) ambient(k) = value = 0.98 * value + test::uniform(20, k);
  CHECK_FALSE(reads_back(inputs, ambient));
  for (int k = 1; k < kRows; ++k) inputs(k, 0) = 0.8 * inputs(k - 1, 0) - 0.2 * ambient(k);
  CHECK_FALSE(reads_back(inputs, ambient));
}

TEST_CASE("few rows, and what stands still, tell of no readback") {
  const Eigen::MatrixXd inputs = commands();
  const Eigen::VectorXd flow = flow_behind(inputs.col(0), 0.0);
  const int enough = rows_to_read_back();
  CHECK(enough == 115);  // 5 + 10 (1 + 5 + 5)
  CHECK(reads_back(inputs.topRows(enough), flow.head(enough)));
  CHECK_FALSE(reads_back(inputs.topRows(enough - 1), flow.head(enough - 1)));
  CHECK_FALSE(reads_back(inputs, Eigen::VectorXd::Constant(kRows, 7.0)));
}

}  // namespace mpm::readback_test
