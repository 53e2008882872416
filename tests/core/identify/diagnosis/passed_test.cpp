#include "core/identify/diagnosis/passed.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::passed_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 900, kFitted = 600, kOnset = 150;
constexpr double kDecay = 60.0;

VectorXd from_onset(double size, double decay) {
  VectorXd added = VectorXd::Zero(kRows);
  for (Index k = kOnset; k < kRows; ++k)
    added(k) = size * std::exp(-static_cast<double>(k - kOnset) / decay);
  return added;
}

/// Of two CVs alike, in noise of s.d. 0.12, the first with what is added.
std::vector<Finding> passed_in(const VectorXd& added, std::uint64_t seed,
                               const std::vector<int>& cvs) {
  const VectorXd u = test::telegraph(seed, kRows, 12);
  const VectorXd answer = test::first_order(u, 2.0, 10.0);
  const auto noise = [&](std::uint64_t of) {
    return VectorXd(0.1 * test::autoregressive(test::normal(seed + of, kRows), 0.5));
  };
  Recording recording = test::recording_of(u, answer + noise(100) + added);
  recording.cvs.conservativeResize(Eigen::NoChange, 2);
  recording.cvs.col(1) = answer + noise(200);
  const ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0), lag(1, 0, 2.0, 10.0)}, 1, 2);
  const Recording fitted = part(recording, 0, kFitted);
  Unseen unseen(recording, kRows - kFitted, model, 1);
  return find_passed(model, 1, fitted, cvs, unseen, {});
}

TEST_CASE("what came and went is named in the CVs that are asked for, and is no repair") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    const std::vector<Finding> passed = passed_in(from_onset(1.5, kDecay), seed, {0, 1});
    REQUIRE(passed.size() == 1);
    CHECK(passed[0].subject == Subject{&causes::step_disturbance(), {0}});
    CHECK(passed[0].parameters[0].name() == "size");
    CHECK(passed[0].parameters[0].value == Approx(1.5).margin(0.3));
    REQUIRE(passed[0].onset_s);
    CHECK(*passed[0].onset_s == Approx(double{kOnset}).margin(3.0));
    CHECK_FALSE(passed[0].repaired);
    CHECK(passed[0].refused == "it had passed before the samples on which repairs are measured");
    CHECK(passed_in(from_onset(1.5, kDecay), seed, {1}).empty());
    CHECK(passed_in(from_onset(1.5, kDecay), seed, {}).empty());
  }
}

// Steps that stay, what is left of a decay in the unseen rows, noise, and what hardly shows.
TEST_CASE("what stays, what is not over and what hardly shows is none that has passed") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    CHECK(passed_in(from_onset(1.5, 1e9), seed, {0, 1}).empty());
    CHECK(passed_in(from_onset(1.5, 500.0), seed, {0, 1}).empty());
    CHECK(passed_in(from_onset(0.1, kDecay), seed, {0, 1}).empty());
    CHECK(passed_in(VectorXd::Zero(kRows), seed, {0, 1}).empty());
  }
}

// Two inputs act on both CVs. A curve of a whole input says nothing of a CV alone.
TEST_CASE(
    "what is asked for are CVs of which something was refused and nothing of their own named") {
  const ModelSpec model = test::model_of(
      {lag(0, 0, 2.0, 10.0), lag(1, 0, 2.0, 10.0), lag(0, 1, 1.0, 5.0), lag(1, 1, 1.0, 5.0)}, 2, 2);
  const auto asked = [&](const std::vector<Effect>& refused, const std::vector<Effect>& named) {
    Account kept;
    kept.refused_effects = refused;
    for (const Effect& effect : named) kept.found.named.emplace_back().effect = effect;
    return without_a_name(kept, model);
  };
  using CVs = std::vector<int>;
  const Effect leak{&causes::input_offset(), {-1, 0}, {}};
  const Effect step{&causes::step_disturbance(), {0}, {}};
  const Effect curve{&causes::input_polynomial(), {-1, 1}, {}};
  const Effect of_one{&causes::input_polynomial(), {1, 1}, {}};
  CHECK(asked({}, {}).empty());
  CHECK(asked({leak}, {}) == CVs{0, 1});
  CHECK(asked({step}, {}) == CVs{0});
  CHECK(asked({leak}, {curve}) == CVs{0, 1});
  CHECK(asked({leak}, {of_one}) == CVs{0});
  CHECK(asked({leak}, {of_one, step}).empty());
}

}  // namespace
}  // namespace mpm::passed_test
