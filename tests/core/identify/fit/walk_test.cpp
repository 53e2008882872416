#include "core/identify/fit/walk.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/fit/mean_reversion.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::walk_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 3000;
constexpr int kSeeds = 60;

/// A plant of two inputs that move as slowly as a walk does, and its model.
struct Bench {
  Recording recording;
  Problem problem;
  Fit fit;

  Bench(const VectorXd& disturbance, double gain_ratio, std::uint64_t seed)
      : recording(recording_with(disturbance, gain_ratio, seed)),
        problem(test::model_of({lag(0, 0, 20.0, 40.0), lag(0, 1, -15.0, 60.0)}, 2, 1), 2, recording,
                Tolerances{}, NoiseModel{}),
        fit(problem.fit({}, 0, {0}, 8)) {}

  static Recording recording_with(const VectorXd& disturbance, double ratio, std::uint64_t seed) {
    Eigen::MatrixXd inputs(kRows, 2);
    for (Index i = 0; i < 2; ++i)
      inputs.col(i) = test::telegraph(10 * seed + static_cast<std::uint64_t>(i), kRows, 200);
    return test::recording_of(inputs, ratio * test::first_order(inputs.col(0), 20.0, 40.0) +
                                          test::first_order(inputs.col(1), -15.0, 60.0) +
                                          disturbance);
  }
  [[nodiscard]] VectorXd left() const { return left_beside_a_walk(problem.data(0), fit.cvs[0]); }
};

// The share of walks that pass is 0.1 %, however well small errors could follow them: of 60 more
// than 2 with a probability of 4e-5. What a fit leaves of the same walks passes for more.
TEST_CASE("small errors make no walk come back") {
  int back = 0, back_behind_the_fit = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const VectorXd walk = 0.1 * test::autoregressive(test::normal(700 + seed, kRows), 1.0) +
                          (seed % 2 == 0 ? 0.0 : 0.5) * test::normal(800 + seed, kRows);
    const Bench bench(walk, 1.0, seed);
    back += comes_back_beside_breaks(bench.left(), 0) ? 1 : 0;
    back_behind_the_fit += comes_back_beside_breaks(bench.fit.cvs[0].residual, 0) ? 1 : 0;
  }
  CAPTURE(back_behind_the_fit);
  CHECK(back <= 2);
  CHECK(back_behind_the_fit > back);
}

// A gain that is off by 3 % of 20 leaves 0.6 of an input that is rarely moved, beside noise of 0.2
// that forgets within 20 rows: the steps know that it is an error of the model, and what remains of
// it is less than a third.
TEST_CASE("a small error of the model hides no noise that comes back") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const VectorXd noise = 0.06 * test::autoregressive(test::normal(700 + seed, kRows), 0.95);
    const Bench bench(noise, 1.03, seed);
    const VectorXd left = bench.left();
    CAPTURE(seed);
    CHECK(comes_back_beside_breaks(left, 0));
    const VectorXd error = left.array() - left.mean() - (noise.array() - noise.mean());
    CHECK(error.norm() / std::sqrt(double(kRows)) < 0.2);
  }
}

TEST_CASE("what is not known is not known to be left") {
  VectorXd noise = test::normal(1, kRows);
  noise.segment(100, 5).setConstant(std::nan(""));
  const VectorXd left = Bench(noise, 1.0, 1).left();
  CHECK(left.segment(100, 5).array().isNaN().all());
  CHECK(left.head(100).allFinite());
  CHECK(left.tail(kRows - 105).allFinite());
}

}  // namespace
}  // namespace mpm::walk_test
