#include "core/mismatch/input_estimates.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/mismatch/block_covariance.hpp"
#include "core/mismatch/gain_excitation.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::input_estimates_test {
namespace {

constexpr int kRows = 400;

// Rows of [constant, residual lags, inputs' blocks | response]: made up, correlated between inputs.
struct Regression {
  explicit Regression(const RegressionShape& regression_shape)
      : shape(regression_shape), x(kRows, shape.columns()), y(kRows), factor(shape.columns(), 1) {
    for (int k = 0; k < kRows; ++k) {
      x(k, 0) = 1.0;
      for (int c = 1; c < shape.columns(); ++c)
        x(k, c) =
            test::coloured(static_cast<std::uint64_t>(c), k) + (c > 1 ? 0.4 * x(k, c - 1) : 0);
      y(k) = 0.3 * x(k, 1) - 2.0 * x(k, shape.lead_in()) + test::uniform(99, k);
      for (int c = 0; c < shape.columns(); ++c) factor.row()[c] = x(k, c);
      factor.row()[shape.columns()] = y(k);
      factor.update(1.0);
    }
  }
  RegressionShape shape;
  Eigen::MatrixXd x;
  Eigen::VectorXd y;
  GivensQr factor;
};

const RegressionShape kShape{3, 2, 4, 2, {0.9}};  // 5 columns an input

TEST_CASE("estimates and their covariance equal those of batch least squares") {
  // Expected: Householder QR of all rows, and the inverse of X'X, by Eigen.
  const Regression regression(kShape);
  InputEstimates estimates(kShape);
  estimates.read(0, regression.factor);
  const Eigen::VectorXd batch = regression.x.colPivHouseholderQr().solve(regression.y);
  const Eigen::MatrixXd normal = regression.x.transpose() * regression.x;
  const Eigen::MatrixXd inverse =
      normal.llt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
  CHECK(estimates.own_past()(0) == Approx(batch(1)).epsilon(1e-9));
  BlockCovariance covariance(estimates);
  for (int input = 0; input < kShape.inputs; ++input) {
    CAPTURE(input);
    REQUIRE(estimates.moved(input));
    const int at = kShape.lead_in() + input * kShape.block();
    const Eigen::VectorXd scales = estimates.scales(input);
    const Eigen::VectorXd unscaled = estimates.estimate(input).cwiseProduct(scales);
    CHECK((unscaled - batch.segment(at, kShape.block())).norm() < 1e-10);

    covariance.read(estimates, input);
    const Eigen::MatrixXd expected = estimates.norms(input).asDiagonal() *
                                     inverse.block(at, at, kShape.block(), kShape.block()) *
                                     estimates.norms(input).asDiagonal();
    for (int c = 0; c < kShape.block(); ++c) {
      // S'^-1 S^-1 e_c is column c of the covariance's inverse.
      Eigen::VectorXd column = Eigen::VectorXd::Unit(kShape.block(), c);
      CHECK(covariance.variance_of(column) == Approx(expected(c, c)).epsilon(1e-9));
      covariance.whiten(column);
      covariance.whiten_transposed(column);
      CHECK((expected * column - Eigen::VectorXd::Unit(kShape.block(), c)).norm() < 1e-9);
    }
  }
}

TEST_CASE("the excitation index is the s.d. of the gain error's estimate") {
  // Along an error d the estimate is d' C^-1 b / d' C^-1 d with variance 1 / d' C^-1 d; with the
  // other inputs left out, 1 / |R d|^2 with R of the input's columns alone, centred for what comes
  // before the inputs.
  const Regression regression(kShape);
  InputEstimates estimates(kShape);
  estimates.read(0, regression.factor);
  BlockCovariance covariance(estimates);
  GainExcitation excitation(estimates);
  const EstimateNoise noise{0.25, 0.25, 100.0};
  std::vector<ChannelEvidence> evidence(3);
  const Eigen::MatrixXd lead_in = regression.x.leftCols(kShape.lead_in());
  for (int input = 0; input < kShape.inputs; ++input) {
    covariance.read(estimates, input);
    Eigen::VectorXd estimate = estimates.estimate(input);
    covariance.whiten(estimate);
    const Eigen::VectorXd error = estimates.norms(input);  // all coefficients 1, scaled
    excitation.measure(input, error, estimate, estimates, covariance, noise,
                       evidence[static_cast<std::size_t>(input)]);
    const int at = kShape.lead_in() + input * kShape.block();
    const Eigen::VectorXd sum = regression.x.middleCols(at, kShape.block()).rowwise().sum();
    const Eigen::VectorXd left = sum - lead_in * lead_in.colPivHouseholderQr().solve(sum);
    const ChannelEvidence& found = evidence[static_cast<std::size_t>(input)];
    CHECK(found.excitation_index_alone == Approx(0.5 / left.norm()).epsilon(1e-9));
    CHECK(found.excitation_index > found.excitation_index_alone);
  }
  // Neighbours were mixed: the last column of an input goes into the first of the next.
  CHECK(excitation.confounder(0, estimates) == 1);
  CHECK(excitation.confounder(2, estimates) == 1);
}

TEST_CASE("an input that stands still has no estimate") {
  Regression regression(kShape);
  GivensQr factor(kShape.columns(), 1);
  for (int k = 0; k < kRows; ++k) {
    for (int c = 0; c < kShape.columns(); ++c) factor.row()[c] = regression.x(k, c);
    for (int c = 0; c < kShape.block(); ++c)
      factor.row()[kShape.lead_in() + kShape.block() + c] = 0;
    factor.row()[kShape.columns()] = regression.y(k);
    factor.update(1.0);
  }
  InputEstimates estimates(kShape);
  const std::uint64_t before = test::allocation_count();
  estimates.read(0, factor);
  CHECK(test::allocation_count() == before);
  CHECK(estimates.moved(0));
  CHECK_FALSE(estimates.moved(1));
  CHECK(estimates.estimate(1).isZero(0.0));
}

}  // namespace
}  // namespace mpm::input_estimates_test
