#include "core/mismatch/materiality.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <boost/math/distributions/students_t.hpp>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/mismatch/estimate_noise.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::materiality_test {
namespace {

constexpr int kBlock = 12;

// Four directions that overlap, of gain, time constants, a sample later and one earlier.
Eigen::MatrixXd directions() {
  Eigen::MatrixXd d(kBlock, error_column::kCount);
  for (int c = 0; c < d.cols(); ++c)
    for (int r = 0; r < kBlock; ++r)
      d(r, c) = 20.0 * test::uniform(static_cast<std::uint64_t>(c), r) + (c > 0 ? d(r, 0) : 0.0);
  d.col(error_column::kEarlier) = -d.col(error_column::kLater);
  return d;
}

UsualErrorSpace space_of(const Eigen::MatrixXd& columns) {
  UsualErrorSpace space(kBlock);
  for (int c = 0; c < columns.cols(); ++c) {
    Eigen::VectorXd column = columns.col(c);
    space.add(column);
  }
  return space;
}

Eigen::VectorXd draw(std::uint64_t seed) {
  Eigen::VectorXd x(kBlock);
  for (int r = 0; r < kBlock; ++r) x(r) = test::uniform(seed, r);
  return x;
}

TEST_CASE("the space of usual errors is spanned by them") {
  const Eigen::MatrixXd d = directions();
  const UsualErrorSpace space = space_of(d);
  CHECK(space.rank() == 3);  // the last one is the third, turned round
  const Eigen::MatrixXd basis = d.leftCols(3);
  const Eigen::VectorXd x = draw(50);
  const Eigen::VectorXd inside = basis * basis.colPivHouseholderQr().solve(x);
  CHECK(space.explained(x) == Approx(inside.squaredNorm()).epsilon(1e-12));
}

TEST_CASE("three directions reduced say the same of a target") {
  const Eigen::MatrixXd d = directions();
  ErrorReduction reduction(kBlock);
  const Eigen::VectorXd target = draw(51);
  const ReducedErrors reduced = reduction.reduce(target, d, error_column::kLater);
  const Eigen::MatrixXd columns = d.leftCols(3);
  for (const Eigen::Vector3d& x : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.02, -0.01, 0.03)})
    CHECK(reduced.rest_square + (reduced.c - reduced.r * x).squaredNorm() ==
          Approx((target - columns * x).squaredNorm()).epsilon(1e-12));
  const Eigen::Matrix3d covariance = (columns.transpose() * columns).inverse();
  for (int i = 0; i < 3; ++i)
    CHECK(reduced.deviations()(i) == Approx(std::sqrt(covariance(i, i))).epsilon(1e-9));
  // Where the free minimum has the shift positive it is the fit; else the shift is 0.
  const Eigen::Vector3d free = columns.colPivHouseholderQr().solve(target);
  const Eigen::Vector3d turned = reduction.reduce(target, d, error_column::kEarlier).fit();
  const bool later = free(2) > 0.0;
  CHECK((later ? reduced.fit() : turned)(2) == Approx(std::abs(free(2))).epsilon(1e-9));
  CHECK((later ? turned : reduced.fit())(2) == 0.0);
}

TEST_CASE("an error of the model's own kind is sized and held against its limit") {
  // 12 % in gain and 3 % in ln T, exactly: nothing is left over, the fit is the truth, and the
  // p-value that the gain's error is within 5 % is that of t = (0.12 - 0.05) / s.d., three times.
  const Eigen::MatrixXd d = directions();
  const UsualErrorSpace space = space_of(d);
  Materiality materiality(kBlock);
  const EstimateNoise noise{1.0, 1.0, 80.0};
  const MaterialityLimits limits{0.05, 0.10, 0.5};
  ChannelEvidence evidence;
  const Eigen::VectorXd estimate = 0.12 * d.col(0) + 0.03 * d.col(1);
  const std::uint64_t before = test::allocation_count();
  materiality.judge(materiality.fit(estimate, d, noise, evidence), estimate, d, space, limits,
                    noise, evidence);
  CHECK(test::allocation_count() == before);
  CHECK(evidence.usual);
  CHECK(evidence.gain_error.value == Approx(0.12).epsilon(1e-9));
  CHECK(evidence.log_time_error.value == Approx(0.03).epsilon(1e-9));
  const double t = (0.12 - 0.05) / evidence.gain_error.deviation;
  const double tail = boost::math::cdf(boost::math::complement(boost::math::students_t(80.0), t));
  CHECK(evidence.p_value_material == Approx(std::min(1.0, 3.0 * tail)).epsilon(1e-9));
  CHECK_FALSE(evidence.harmless);
}

TEST_CASE("an error of another kind matters where no allowed combination comes near it") {
  const Eigen::MatrixXd d = directions();
  const UsualErrorSpace space = space_of(d);
  Materiality materiality(kBlock);
  const EstimateNoise noise{1.0, 1.0, 80.0};
  const MaterialityLimits limits{0.05, 0.10, 0.5};
  const Eigen::VectorXd x = draw(52);
  const Eigen::MatrixXd basis = d.leftCols(3);
  const Eigen::VectorXd outside = 60.0 * (x - basis * basis.colPivHouseholderQr().solve(x));
  ChannelEvidence large, small;
  const std::uint64_t before = test::allocation_count();
  materiality.judge(materiality.fit(outside, d, noise, large), outside, d, space, limits, noise,
                    large);
  CHECK(test::allocation_count() == before);
  CHECK_FALSE(large.usual);
  CHECK_FALSE(large.harmless);
  CHECK(large.p_value_material < 1e-6);
  materiality.judge(materiality.fit(1e-4 * outside, d, noise, small), 1e-4 * outside, d, space,
                    limits, noise, small);
  CHECK(small.usual);
  CHECK(small.p_value_material == 1.0);
}

TEST_CASE("without dead time no answer is earlier, whatever rounding leaves of that direction") {
  // A first-order lag that answers a sample earlier is the same lag with more gain: what rounding
  // leaves of the difference would make gain and dead time cancel at any size.
  Eigen::MatrixXd d = directions();
  for (int r = 0; r < kBlock; ++r)
    d(r, error_column::kEarlier) = 0.1 * d(r, 0) + 1e-5 * test::uniform(53, r);
  const UsualErrorSpace space = space_of(d.leftCols(3));
  Materiality materiality(kBlock);
  const EstimateNoise noise{1.0, 1.0, 80.0};
  const MaterialityLimits limits{0.05, 0.10, 0.5};
  ChannelEvidence evidence;
  evidence.dead_time = 0.0;
  // One s.d. of noise, where only that direction leads.
  const Eigen::MatrixXd basis = d.leftCols(2);
  const Eigen::VectorXd earlier = d.col(error_column::kEarlier);
  const Eigen::VectorXd beside = earlier - basis * basis.colPivHouseholderQr().solve(earlier);
  const Eigen::VectorXd estimate = 0.4 * d.col(0) + beside.normalized();
  materiality.judge(materiality.fit(estimate, d, noise, evidence), estimate, d, space, limits,
                    noise, evidence);
  CHECK(evidence.usual);
  CHECK(evidence.gain_error.value == Approx(0.4).margin(0.05));
  CHECK(evidence.gain_error.deviation < 0.2);
  CHECK(evidence.dead_time_error.value >= 0.0);
  CHECK(evidence.p_value_material < 0.01);
}

TEST_CASE("few rows and forgetting make the estimates noisier") {
  // Two columns, weights alike: W1 = W2 = rows. Variance = RSS / freedom, times 1 + 1.35 c
  // + 6 c^2 (0.26, 1), c = columns / freedom, the factors of docs/validation.md.
  RegressionMemory memory(2, {});
  RowBatch batch(3, 1);
  const double whole = 1.0;
  for (int k = 0; k < 42; ++k) {
    batch.row(0)[0] = 1.0;
    batch.row(0)[1] = k % 2 == 0 ? 1.0 : -1.0;
    batch.row(0)[2] = k % 4 < 2 ? 2.0 : -2.0;
    memory.take(batch, &whole, 1);
  }
  const double variance = memory.factor.residual_square(0) / 40.0;
  const EstimateNoise noise = estimate_noise(memory);
  CHECK(noise.freedom == 40.0);
  CHECK(noise.variance == Approx(variance * (1.0 + 1.35 * 0.05 + 6.0 * 0.0025)).epsilon(1e-12));
  CHECK(noise.block_variance ==
        Approx(variance * (1.0 + 0.26 * 0.05 + 1.0 * 0.0025)).epsilon(1e-12));
}

// Judged together with others, a channel is as many numbers as there are usual errors, however few
// coefficients it is regressed on: where rows are few these are fewer.
TEST_CASE("a channel of fewer coefficients than usual errors has room for these") {
  constexpr int kFew = 3;
  static_assert(kFew < kUsualErrors);
  Materiality materiality(kFew);
  UsualErrorSpace space(kUsualErrors);
  Eigen::MatrixXd d = 20.0 * Eigen::MatrixXd::Identity(kUsualErrors, error_column::kCount);
  for (int c = 0; c < 3; ++c) {
    Eigen::VectorXd column = d.col(c);
    space.add(column);
  }
  const Eigen::VectorXd estimate = d * Eigen::Vector4d(0.3, 0.0, 0.0, 0.0);
  const EstimateNoise noise{1.0, 1.0, 80.0};
  ChannelEvidence evidence;
  evidence.dead_time = 5.0;
  const double left = materiality.fit(estimate, d, noise, evidence);
  materiality.judge(left, estimate, d, space, {0.05, 0.10, 0.5}, noise, evidence);
  REQUIRE(materiality.beside_allowed().size() >= kUsualErrors);
  CHECK(evidence.gain_error.value == Approx(0.3));
}

}  // namespace
}  // namespace mpm::materiality_test
