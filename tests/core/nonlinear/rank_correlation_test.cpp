#include "core/nonlinear/rank_correlation.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "tests/allocation_counter.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::rank_correlation_test {
namespace {

constexpr int kFirstLag = -2, kLastLag = 5, kLength = 400;

// Two inputs that move together, and a CV that follows the cube of the first three samples later.
double input(int which, int k) {
  return test::uniform(1, k) + 0.5 * test::uniform(2 + static_cast<std::uint64_t>(which), k);
}
double residual(int k, double noise) {
  return std::pow(input(0, k - 3), 3) + noise * test::uniform(9, k);
}

RankCorrelation after(int samples, bool partial, double noise) {
  RankCorrelation correlation({2, 1, kFirstLag, kLastLag, partial}, kLength);
  for (int k = 0; k < samples; ++k)
    correlation.update(Eigen::Vector2d(input(0, k), input(1, k)),
                       Eigen::VectorXd::Constant(1, residual(k, noise)));
  correlation.evaluate();
  return correlation;
}

// The same rows in a window of their own, the first where the first lag has its first sample: by
// another way.
double of_rows(int samples, int lag, bool partial) {
  RankWindow window(3, kLength);
  for (int t = 2; t + kLastLag < samples; ++t)
    window.push(Eigen::Vector3d(input(0, t), input(1, t), residual(t + lag, 0.1)));
  const std::vector<int> held = {1};
  return partial ? window.partial_coefficient(0, 2, held) : window.coefficient(0, 2);
}

TEST_CASE("rank correlations are those of the rows of each lag") {
  for (const bool partial : {false, true})
    for (const int samples : {200, 700}) {  // a window that is not full, and one that slides
      const RankCorrelation correlation = after(samples, partial, 0.1);
      for (int lag = kFirstLag; lag <= kLastLag; ++lag) {
        CAPTURE(partial, samples, lag);
        CHECK(correlation.correlations(0, 0)(lag - kFirstLag) ==
              Approx(of_rows(samples, lag, partial)).margin(1e-12));
      }
    }
}

// The ranks of a cube are those of what it is of: 1 at its lag, and nothing is left for others.
TEST_CASE("what bends is seen at its lag, and held inputs take their part away") {
  const RankCorrelation plain = after(1000, false, 0.0), partial = after(1000, true, 0.0);
  const auto at = [](const RankCorrelation& correlation, int which) {
    return correlation.correlations(0, which)(3 - kFirstLag);
  };
  CHECK(at(plain, 0) == Approx(1.0));
  CHECK(at(plain, 1) > 0.5);
  CHECK(at(partial, 0) == Approx(1.0));
  CHECK(at(partial, 1) == 0.0);
}

// Eight samples make the first row. Those before the gap rise together, those after it oppose each
// other: a row across it would tell.
TEST_CASE("no row of ranks spans a gap") {
  RankCorrelation correlation({1, 1, kFirstLag, kLastLag, false}, kLength);
  const auto push = [&correlation](double input, double residual) {
    correlation.update(Eigen::VectorXd::Constant(1, input), Eigen::VectorXd::Constant(1, residual));
  };
  for (int k = 0; k < 7; ++k) push(k, k);
  correlation.close_window();
  for (int k = 0; k < 7; ++k) push(k, -k);
  correlation.evaluate();
  CHECK(correlation.correlations(0, 0).isZero());
  for (int k = 7; k < 17; ++k) push(k, -k);
  correlation.evaluate();
  CHECK(correlation.correlations(0, 0).isApproxToConstant(-1.0));
}

TEST_CASE("a signal that stands still has no rank correlation") {
  for (const bool partial : {false, true}) {
    RankCorrelation correlation({2, 1, 0, 2, partial}, 50);
    for (int k = 0; k < 60; ++k)
      correlation.update(Eigen::Vector2d(4.0, input(0, k)),
                         Eigen::VectorXd::Constant(1, residual(k, 0.1)));
    correlation.evaluate();
    CHECK(correlation.correlations(0, 0).isZero());
    CHECK_FALSE(correlation.correlations(0, 1).isZero());
  }
}

TEST_CASE("taking and asking for rank correlations allocates nothing") {
  RankCorrelation correlation({2, 1, kFirstLag, kLastLag, true}, kLength);
  const Eigen::Vector2d inputs(1.0, 2.0);
  const Eigen::VectorXd residuals = Eigen::VectorXd::Constant(1, 3.0);
  const std::uint64_t before = test::allocation_count();
  for (int k = 0; k < 20; ++k) correlation.update(inputs, residuals);
  correlation.evaluate();
  CHECK(test::allocation_count() == before);
}

TEST_CASE("impossible shapes of rank correlations are refused") {
  CHECK_THROWS_AS(RankCorrelation({0, 1, 0, 2, false}, 50), std::invalid_argument);
  CHECK_THROWS_AS(RankCorrelation({1, 1, 3, 2, false}, 50), std::invalid_argument);
}

}  // namespace
}  // namespace mpm::rank_correlation_test
