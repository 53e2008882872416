#include "core/identify/search/walk_odds.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/proposals.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::walk_odds_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 3000, kOnset = 1200;
constexpr double kStep = 0.1;  ///< s.d. of the walk's steps

VectorXd walk(std::uint64_t seed) {
  return kStep * test::autoregressive(test::normal(seed, kRows), 1.0);
}

/// Zero for so many rows, then `size` (times the rows since where it drifts).
VectorXd from_onset(double size, bool drifts) {
  return VectorXd::NullaryExpr(kRows, [&](Index k) {
    return k < kOnset ? 0.0 : size * (drifts ? double(k - kOnset) : 1.0);
  });
}

struct Bench {
  VectorXd u;
  Recording recording;
  Problem problem;
  Fit fit;

  Bench(const VectorXd& disturbance, const Effect& effect,
        const VectorXd& input = test::telegraph(1, kRows, 12))
      : u(input),
        recording(test::recording_of(u, test::first_order(u, 2.0, 10.0) + disturbance)),
        problem(test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1), 1, recording, Tolerances{},
                NoiseModel{}),
        fit(problem.fit({effect}, 0, {0}, 8)) {}

  double evidence() { return evidence_on_walk(problem, fit, 0, fit.cvs[0]).value(); }
};

Effect effect_of(const Cause& cause, const char* quantity, double prior_sd) {
  const Quantity& size = test::quantity_of(cause, quantity);
  Effect effect{&cause, {0}, {{&size, 0.0, 0.0, prior_sd, 0.01 * prior_sd, -1e9, 1e9}}};
  effect.onset = kOnset;
  return effect;
}
Effect step() { return effect_of(causes::step_disturbance(), "size", 2.0); }
Effect gain() {
  return {&causes::gain(), {0, 0}, {{&kGainRatio, 1.0, 1.0, 0.25, 0.01, 0.02, 20.0}}};
}
Effect drift() { return effect_of(causes::drift_disturbance(), "rate", 0.02); }

// Of n steps of s.d. s one is larger by J: n ln(1 + (J + its own)^2 / (n s^2)), that is 98 of 10 s.
// A drift of d a row over m rows: m d^2 / s^2, that is 45 of s / 6.3 a row, with an s.d. of 13.
TEST_CASE("on a walk a step counts by its jump, a drift by what it adds to the walk's own") {
  for (const std::uint64_t seed : {11u, 12u, 13u}) {
    CAPTURE(seed);
    Bench stepped(walk(seed) + from_onset(10.0 * kStep, false), step());
    CHECK(stepped.evidence() == Approx(98.0).margin(70.0));  // 2 * 10 s, times 3.5 s.d.
    Bench drifting(walk(seed) + from_onset(kStep / 6.3, true), drift());
    CHECK(drifting.evidence() == Approx(45.0).margin(45.0));
    CHECK(drifting.evidence() > 5.0);
  }
}

// What a walk does by itself: chi-square of one degree of freedom at most, under noise or not: 3.84
// in one of 20, so that of 60 walks more than 10 exceed it with a probability of 2e-4. The noise
// that a fit takes for its own says much more of the drifts.
TEST_CASE("a walk makes no evidence for a drift") {
  int seen = 0, believed = 0;
  for (std::uint64_t seed = 100; seed < 160; ++seed) {
    const double noise = seed % 2 == 0 ? 0.0 : 10.0 * kStep;
    Bench bench(walk(seed) + noise * test::normal(seed + 1000, kRows), drift());
    seen += bench.evidence() > 3.84 ? 1 : 0;
    Fit without = bench.problem.fit({}, 0, {0}, 8);
    believed += without.cost - bench.fit.cost > 3.84 ? 1 : 0;
  }
  CAPTURE(believed);
  CHECK(seen <= 10);
  CHECK(believed > seen);
}

TEST_CASE("only what is a function of time can cut a walk, and only a walk is cut") {
  Bench on_walk(walk(21), drift());
  CHECK(cuts_a_walk(on_walk.problem, on_walk.fit, 0));
  Bench on_noise(kStep * test::normal(21, kRows), drift());
  CHECK_FALSE(cuts_a_walk(on_noise.problem, on_noise.fit, 0));
  CHECK(most_odds(on_walk.problem, on_walk.fit, 0) <= on_walk.evidence());
  CHECK(most_odds(on_noise.problem, on_noise.fit, 0) > 200.0);  // bounds nothing
  Bench of_channel(walk(21), gain());
  CHECK_FALSE(cuts_a_walk(of_channel.problem, of_channel.fit, 0));
}

// An input that wanders, too, goes with any walk, under noise of ten of its steps more than a fit
// believes. Chance of more than 3.84 as above. An error of its channel stands out all the same: in
// a hundred rows both walks move by what the noise is, and 30 hundreds tell 1/6 of the ratio.
TEST_CASE("between two walks there is no evidence for a channel's error, but for a real one") {
  int seen = 0, believed = 0, found = 0;
  for (std::uint64_t seed = 200; seed < 260; ++seed) {
    const VectorXd input = walk(seed + 500);
    const VectorXd wander = walk(seed) + 10.0 * kStep * test::normal(seed + 1000, kRows);
    Bench sound(wander, gain(), input);
    seen += sound.evidence() > 3.84 ? 1 : 0;
    const Fit without = sound.problem.fit({}, 0, {0}, 8);
    believed += without.cost - sound.fit.cost > 3.84 ? 1 : 0;
    Bench wrong(wander + test::first_order(input, 2.0, 10.0), gain(), input);
    found += wrong.evidence() > 3.84 ? 1 : 0;
  }
  CAPTURE(seen, believed, found);
  CHECK(seen <= 10);
  CHECK(believed > seen);
  CHECK(found >= 50);
}

TEST_CASE("without noise nothing bounds what is there") {
  Bench bench(from_onset(1.0, false), step());
  CHECK(most_odds(bench.problem, bench.fit, 0) > 1e4);
}

TEST_CASE("what adds nothing to a CV has no evidence there") {
  Bench bench(walk(1), gain(), VectorXd::Zero(kRows));
  CHECK_FALSE(evidence_on_walk(bench.problem, bench.fit, 0, bench.fit.cvs[0]));
}

}  // namespace
}  // namespace mpm::walk_odds_test
