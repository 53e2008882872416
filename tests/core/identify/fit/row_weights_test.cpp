#include "core/identify/fit/row_weights.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Median of |x| of a normal variable of s.d. 1 (tables of the normal distribution).
constexpr double kMedian = 0.67448975;

VectorXd alternating(Index rows, double size) {
  return VectorXd::NullaryExpr(rows, [&](Index k) { return k % 2 == 0 ? size : -size; });
}

TEST_CASE("rows that are all alike count alike") {
  VectorXd weights = VectorXd::Ones(900);
  reweigh(alternating(900, 0.3), weights);
  CHECK(weights.isApproxToConstant(1.0, 1e-12));
}

// |x| = 1 everywhere is what a normal variable of s.d. 1 / 0.6745 would have as its median; beyond
// three of those, Huber's weight squared; then all are scaled to a mean of 1.
TEST_CASE("an outlier counts as the square of Huber's weight") {
  VectorXd innovations = alternating(900, 1.0);
  innovations(400) = 10.0;
  VectorXd weights = VectorXd::Ones(900);
  reweigh(innovations, weights);
  const double huber = std::pow(3.0 / kMedian / 10.0, 2);
  const double scale = 900.0 / (899.0 + huber);
  CHECK(weights(400) == Approx(huber * scale).epsilon(1e-8));
  CHECK(weights(401) == Approx(scale).epsilon(1e-12));
  innovations(400) = 0.99 * 3.0 / kMedian;  // within three s.d.
  weights.setOnes();
  reweigh(innovations, weights);
  CHECK(weights.isApproxToConstant(1.0, 1e-12));
}

// Far from where the noise doubles, a row counts by the inverse of its variance.
TEST_CASE("a stretch that is twice as loud counts a quarter") {
  VectorXd innovations = alternating(2400, 1.0);
  innovations.tail(1200) *= 2.0;
  VectorXd weights = VectorXd::Ones(2400);
  reweigh(innovations, weights);
  for (const Index k : {0, 300, 900}) CHECK(weights(k) == Approx(weights(10)).epsilon(1e-12));
  for (const Index k : {1500, 2000, 2399})
    CHECK(weights(k) == Approx(weights(10) / 4.0).epsilon(1e-12));
  CHECK(weights.sum() == Approx(2400.0).epsilon(1e-12));
  CHECK(weights(1200) < weights(10));
  CHECK(weights(1200) > weights(10) / 4.0 - 1e-12);
}

TEST_CASE("rows that do not count stay so and are not asked") {
  VectorXd innovations = alternating(900, 1.0);
  VectorXd weights = VectorXd::Ones(900);
  weights.segment(100, 200).setZero();
  innovations.segment(100, 200).setConstant(1e6);
  reweigh(innovations, weights);
  CHECK(weights.segment(100, 200).isZero(0.0));
  CHECK(weights(0) == Approx(1.0).epsilon(1e-12));
  CHECK(weights(899) == Approx(1.0).epsilon(1e-12));
}

TEST_CASE("where nothing is left there is nothing to weigh by") {
  VectorXd weights = VectorXd::Ones(100);
  reweigh(VectorXd::Zero(100), weights);
  CHECK(weights.isApproxToConstant(1.0, 0.0));
  weights.setZero();
  reweigh(alternating(100, 1.0), weights);
  CHECK(weights.isZero(0.0));
}

// Of normal noise, 0.27 % lie beyond three s.d.: nearly all weights are those of a scale that is
// known to some 7 % (s.d. of a median of 300).
TEST_CASE("normal noise keeps its weights") {
  VectorXd weights = VectorXd::Ones(3000);
  reweigh(test::normal(1, 3000), weights);
  CHECK(weights.sum() == Approx(3000.0).epsilon(1e-12));
  CHECK((weights.array() > 0.6).count() > 2960);
  CHECK((weights.array() < 1.6).count() == 3000);
}

}  // namespace
}  // namespace mpm
