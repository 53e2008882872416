#include "core/identify/causes/step_moments.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::step_moments_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kRows = 500;

/// Coloured noise of variance 1 in its innovations, and `added`.
test::KnownCv residual_with(const VectorXd& added, std::uint64_t stream) {
  const double a = 0.8;
  return test::known_cv(test::autoregressive(test::white(stream, kRows), a) + added,
                        VectorXd::Constant(1, a));
}

VectorXd step(Index onset, double size, double time_constant = 0.0) {
  return VectorXd::NullaryExpr(kRows, [&](Index k) {
    if (k < onset) return 0.0;
    const double since = static_cast<double>(k - onset);
    return time_constant > 0.0 ? size * (1.0 - std::exp(-since / time_constant)) : size;
  });
}

// Hidden by the test at a row that it knows. Whitened by 1 - 0.8 q^-1, a step of 8 is a pulse of 8
// beside noise of 1.
TEST_CASE("the row of a hidden step comes first") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto onset = static_cast<Index>(40 + 20 * seed);
    CAPTURE(seed, onset);
    const test::KnownCv cv = residual_with(step(onset, 8.0), seed);
    const std::vector<Index> moments = step_moments(cv.data, cv.fit, {}, 3);
    REQUIRE(moments.size() == 3);
    CHECK(moments[0] == onset);
    // Down counts as much as up.
    const test::KnownCv down = residual_with(step(onset, -8.0), seed);
    CHECK(step_moments(down.data, down.fit, {}, 1) == std::vector<Index>{onset});
  }
}

// Whitened, a lagged step has no edge: what is told is where, to within a part of its lag.
TEST_CASE("the row of a lagged step is found where its lag is known") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto onset = static_cast<Index>(60 + 15 * seed);
    CAPTURE(seed, onset);
    const test::KnownCv cv = residual_with(step(onset, 25.0, 12.0), seed);
    const std::vector<Index> moments = step_moments(cv.data, cv.fit, {12.0, 0.0}, 2);
    REQUIRE_FALSE(moments.empty());
    CHECK(std::abs(moments[0] - onset) <= 4);
  }
}

/// Of a step of that form from `onset` on: how much of the whitened rows it explains by least
/// squares, (s e)^2 / (s s) with s the whitened step.
double explained(const test::KnownCv& cv, Index onset, const StepForm& form) {
  VectorXd plain = step(onset, 1.0, form.time_constant);
  for (Index k = onset; k < kRows && form.decay > 0.0; ++k)
    plain(k) *= std::exp(-static_cast<double>(k - onset) / form.decay);
  VectorXd added = plain;
  const VectorXd& a = cv.fit.noise.coefficients;
  for (Index k = kRows - 1; k >= 0; --k)
    for (Index l = 1; l <= a.size() && l <= k; ++l) added(k) -= a(l - 1) * plain(k - l);
  return std::pow(added.dot(cv.fit.innovations), 2) / added.squaredNorm();
}

// Noise alone, in which the best of all rows depends on every digit: by brute force.
TEST_CASE("moments are those of a step by least squares, best first") {
  for (const StepForm& form :
       {StepForm{}, {.time_constant = 15.0}, {.decay = 25.0}, {15.0, 25.0}}) {
    const VectorXd noise = test::autoregressive(test::white(7, kRows), 0.7);
    const test::KnownCv cv = test::known_cv(noise, Eigen::Vector2d(0.9, -0.3));
    std::vector<std::pair<double, Index>> all;
    for (Index k = 5; k + 5 < kRows; ++k) all.emplace_back(explained(cv, k, form), k);
    std::sort(all.rbegin(), all.rend());
    std::vector<Index> expected;
    for (const auto& [gain, k] : all)
      if (expected.size() < 6 && std::none_of(expected.begin(), expected.end(),
                                              [k = k](Index row) { return std::abs(row - k) < 4; }))
        expected.push_back(k);
    CHECK(step_moments(cv.data, cv.fit, form, 6) == expected);
  }
}

TEST_CASE("moments are as many as asked for, apart, and not at the ends") {
  const test::KnownCv cv = residual_with(step(250, 8.0), 3);
  const std::vector<Index> moments = step_moments(cv.data, cv.fit, {}, 8);
  REQUIRE(moments.size() == 8);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    CHECK(moments[i] >= 5);
    CHECK(moments[i] + 5 < kRows);
    for (std::size_t j = 0; j < i; ++j) CHECK(std::abs(moments[i] - moments[j]) >= 4);
  }
  const test::KnownCv silent = test::known_cv(VectorXd::Zero(100), VectorXd());
  CHECK(step_moments(silent.data,
                     {silent.fit.cv, {}, {}, silent.fit.residual, silent.fit.innovations, 1.0}, {},
                     8)
            .empty());
}

}  // namespace
}  // namespace mpm::step_moments_test
