#include "core/statistics/level_change.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "core/statistics/calibration.hpp"

namespace mpm {
namespace {

std::vector<LevelPoint> series(const std::vector<double>& values, double deviation = 0.0) {
  std::vector<LevelPoint> points;
  for (std::size_t i = 0; i < values.size(); ++i)
    points.push_back({static_cast<double>(i), values[i], deviation});
  return points;
}

// x(k) = r x(k-1) + w(k), stationary, of variance 1.
std::vector<double> wandering(std::mt19937_64& random, std::size_t count, double r) {
  std::normal_distribution<double> normal;
  std::vector<double> values{normal(random)};
  while (values.size() < count)
    values.push_back(r * values.back() + std::sqrt(1.0 - r * r) * normal(random));
  return values;
}

}  // namespace

TEST_CASE("a step is found at its place, with both levels") {
  const auto change = find_level_change(series({1.1, 0.9, 1.0, 1.1, 0.9, 3.0, 3.1, 2.9, 3.0, 3.0}));
  REQUIRE(change);
  CHECK_FALSE(change->gradual);
  CHECK(change->first == 5);
  CHECK(change->before == Approx(1.0));  // means of the values
  CHECK(change->after == Approx(3.0));
  CHECK(change->p_value < 1e-5);
  CHECK(change->deviation < 0.1);
}

TEST_CASE("a bend is found at its place, with where the line ends") {
  const auto change = find_level_change(
      series({0.05, -0.05, 0.0, 0.05, -0.05, 0.0, 1.0, 2.05, 2.95, 4.0, 5.0, 6.0}));
  REQUIRE(change);
  CHECK(change->gradual);
  CHECK(change->first == 5);
  CHECK(change->before == Approx(0.0).margin(0.05));
  CHECK(change->after == Approx(6.0).margin(0.1));
  CHECK(change->p_value < 1e-5);
}

TEST_CASE("few points say nothing, nor do points that are known too badly") {
  CHECK_FALSE(find_level_change(series({0, 0, 0, 9, 9})));
  const std::vector<double> step{0.1, -0.1, 0.0, 0.1, -0.1, 5.0, 5.1, 4.9, 5.0, 5.1};
  CHECK(find_level_change(series(step, 0.1))->p_value < 1e-5);
  CHECK(find_level_change(series(step, 10.0))->p_value == 1.0);
  CHECK(find_level_change(series(std::vector<double>(8, 3.0)))->p_value == 1.0);
}

// Normal values: where they are independent no more are below a level than it says; where
// neighbours resemble each other a little no more than twice as many (both by four s.d. of the
// count).
TEST_CASE("of series that do not change no more are told than the p-value says") {
  constexpr int kRuns = 4000;
  std::mt19937_64 random(17);
  for (const double r : {0.0, 0.3}) {
    const double times = r > 0.0 ? 2.0 : 1.0;
    for (const std::size_t count : {6, 8, 12, 30, 60}) {
      int below_tenth = 0, below_hundredth = 0;
      for (int run = 0; run < kRuns; ++run) {
        const double p = find_level_change(series(wandering(random, count, r)))->p_value;
        below_tenth += p < 0.1 ? 1 : 0;
        below_hundredth += p < 0.01 ? 1 : 0;
      }
      CAPTURE(count, r, below_tenth, below_hundredth);
      CHECK(below_tenth <= times * 0.1 * kRuns + 4.0 * std::sqrt(0.09 * kRuns));
      CHECK(below_hundredth <= times * 0.01 * kRuns + 4.0 * std::sqrt(0.0099 * kRuns));
    }
  }
}

}  // namespace mpm
