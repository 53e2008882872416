#include "core/identify/search/jumps_together.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/noise_choice.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::jumps_together_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 2400;

/// Of a CV that answers one input as its model does, what is found beside `disturbance`, as the
/// rows at which steps begin.
std::vector<Index> steps_in(const VectorXd& disturbance, std::uint64_t seed) {
  const VectorXd u = test::telegraph(seed, kRows, 12);
  const ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  const Recording recording = test::recording_of(u, test::first_order(u, 2.0, 10.0) + disturbance);
  Problem problem(model, 1, recording, Tolerances{}, free_noise(model, 1, recording));
  std::vector<Index> onsets;
  for (const Named& named : search(problem, SearchSettings{}).named)
    if (named.effect.edit == &causes::step_disturbance()) onsets.push_back(named.effect.onset);
  std::sort(onsets.begin(), onsets.end());
  return onsets;
}

VectorXd noise(std::uint64_t seed) {
  return test::autoregressive(test::normal(seed + 100, kRows), 0.9);
}

VectorXd steps(const std::vector<Index>& rows, double size) {
  VectorXd added = VectorXd::Zero(kRows);
  for (const Index row : rows) added.tail(kRows - row).array() += size;
  return added;
}

// Steps of eight s.d. of the innovations (3.5 of the noise). Beside the others each is one large
// innovation of a noise that would remember it for good.
TEST_CASE("a staircase is found, step by step") {
  const std::vector<Index> rows = {500, 1000, 1500, 2000};
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const std::vector<Index> onsets = steps_in(noise(seed) + steps(rows, 8.0), seed);
    found += onsets.size() == rows.size() &&
             std::equal(rows.begin(), rows.end(), onsets.begin(),
                        [](Index a, Index b) { return std::abs(a - b) <= 1; });
  }
  CHECK(found >= 5);
}

// Innovations of eight s.d. that the noise forgets, and a random walk of the same innovations.
TEST_CASE("shocks of the noise and a random walk are no staircase") {
  for (std::uint64_t seed = 11; seed <= 16; ++seed) {
    CAPTURE(seed);
    VectorXd white = test::normal(seed + 100, kRows);
    for (const Index row : {500, 1000, 1500, 2000}) white(row) += 8.0;
    CHECK(steps_in(test::autoregressive(white, 0.9), seed).empty());
    CHECK(steps_in(test::autoregressive(test::normal(seed + 200, kRows), 1.0), seed).empty());
  }
}

// Far beyond the noise: each is found by itself, and none is lost for another.
TEST_CASE("two large steps of one CV are found at their own moments") {
  for (std::uint64_t seed = 21; seed <= 23; ++seed) {
    CAPTURE(seed);
    const std::vector<Index> onsets = steps_in(noise(seed) + steps({700, 1700}, 20.0), seed);
    REQUIRE(onsets.size() == 2);
    CHECK(std::abs(onsets[0] - 700) <= 1);
    CHECK(std::abs(onsets[1] - 1700) <= 1);
  }
}

}  // namespace
}  // namespace mpm::jumps_together_test
