#include "core/nonlinear/rank_window.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/allocation_counter.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm {
namespace {

using Columns = std::vector<std::vector<double>>;

// Mean ranks by their definition.
std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<double> result;
  for (const double value : values) {
    double below = 0.0, same = 0.0;
    for (const double other : values) {
      below += other < value ? 1.0 : 0.0;
      same += other == value ? 1.0 : 0.0;
    }
    result.push_back(below + 0.5 * (same + 1.0));
  }
  return result;
}

double pearson(const std::vector<double>& x, const std::vector<double>& y) {
  const auto count = static_cast<double>(x.size());
  double x_mean = 0.0, y_mean = 0.0;
  for (std::size_t l = 0; l < x.size(); ++l) {
    x_mean += x[l] / count;
    y_mean += y[l] / count;
  }
  double product = 0.0, x_square = 0.0, y_square = 0.0;
  for (std::size_t l = 0; l < x.size(); ++l) {
    product += (x[l] - x_mean) * (y[l] - y_mean);
    x_square += (x[l] - x_mean) * (x[l] - x_mean);
    y_square += (y[l] - y_mean) * (y[l] - y_mean);
  }
  return product / std::sqrt(x_square * y_square);
}

double of_three(double ab, double ac, double bc) {
  return (ab - ac * bc) / std::sqrt((1.0 - ac * ac) * (1.0 - bc * bc));
}

// Values on a grid of `steps` per unit, so that there are ties, or without a grid.
double sample(int signal, int k, int steps) {
  const double shared = test::uniform(1, k);
  const double value = test::uniform(10 + static_cast<std::uint64_t>(signal), k) +
                       (signal == 2 ? 0.0 : 0.7 * shared);
  return steps > 0 ? std::round(value * steps) / steps : value;
}

}  // namespace

TEST_CASE("rank coefficients on a sliding window are those of the window alone") {
  // Batch recomputation; without ties also 1 - 6 sum d^2 / (n (n^2 - 1)) (Spearman 1904).
  const int steps = GENERATE(0, 3, 1);
  constexpr int kLength = 40;
  const std::vector<int> held = {2};
  RankWindow window(3, kLength);
  Columns all(3);
  for (int k = 0; k < 150; ++k) {
    Eigen::VectorXd row(3);
    for (int s = 0; s < 3; ++s) {
      row(s) = sample(s, k, steps);
      all[static_cast<std::size_t>(s)].push_back(row(s));
    }
    window.push(row);
    const int count = std::min(k + 1, kLength);
    REQUIRE(window.count() == count);
    if (k < 3 || k % 7 != 0) continue;
    Columns expected;
    for (const std::vector<double>& column : all)
      expected.push_back(ranks({column.end() - count, column.end()}));
    for (int age = 0; age < count; ++age)
      REQUIRE(window.rank(1, age) == expected[1][static_cast<std::size_t>(count - 1 - age)]);
    CAPTURE(k, steps);
    const double ab = pearson(expected[0], expected[1]);
    const double ac = pearson(expected[0], expected[2]);
    const double bc = pearson(expected[1], expected[2]);
    CHECK(window.coefficient(0, 1) == Approx(ab).margin(1e-12));
    CHECK(window.coefficient(2, 1) == Approx(bc).margin(1e-12));
    CHECK(window.partial_coefficient(0, 1, held) == Approx(of_three(ab, ac, bc)).margin(1e-12));
    if (steps > 0) continue;
    double squares = 0.0;
    for (std::size_t l = 0; l < expected[0].size(); ++l)
      squares += std::pow(expected[0][l] - expected[1][l], 2);
    CHECK(window.coefficient(0, 1) ==
          Approx(1.0 - 6.0 * squares / (count * (count * count - 1.0))).margin(1e-12));
  }
}

TEST_CASE("ranks see what is monotone, and no square about its vertex") {
  RankWindow window(2, 2000);
  RankWindow square(2, 2000);
  for (int k = 0; k < 2000; ++k) {
    const double x = test::uniform(3, k);
    window.push(Eigen::Vector2d(x, std::exp(8.0 * x)));
    square.push(Eigen::Vector2d(x, x * x));
  }
  CHECK(window.coefficient(0, 1) == 1.0);
  CHECK(std::abs(square.coefficient(0, 1)) < 4.0 / std::sqrt(2000.0));  // four s.d. of chance
}

TEST_CASE("the p-value of a rank partial coefficient is uniform where there is nothing") {
  // 400 independent windows: a share below 0.05 that is off by more than four s.d. (0.0109 each)
  // comes once in 16 000.
  int below = 0;
  for (std::uint64_t w = 0; w < 400; ++w) {
    RankWindow window(4, 60);
    for (int k = 0; k < 60; ++k) {
      Eigen::VectorXd row(4);
      for (int s = 0; s < 4; ++s)
        row(s) = test::uniform(100 + 4 * w + static_cast<std::uint64_t>(s), k);
      window.push(row);
    }
    below += window.p_value(window.partial_coefficient(0, 1, std::vector{2, 3}), 2) < 0.05 ? 1 : 0;
  }
  CHECK(below > 400 * (0.05 - 4 * 0.0109));
  CHECK(below < 400 * (0.05 + 4 * 0.0109));
}

TEST_CASE("a constant signal has no rank coefficient, and nothing is allocated") {
  RankWindow window(2, 50);
  Eigen::VectorXd row(2);
  const std::uint64_t before = test::allocation_count();
  for (int k = 0; k < 120; ++k) {
    row << 1.0, test::uniform(4, k);
    window.push(row);
  }
  CHECK(window.coefficient(0, 1) == 0.0);
  CHECK(window.partial_coefficient(0, 1, {}) == 0.0);
  CHECK(test::allocation_count() == before);
  CHECK_THROWS_AS(RankWindow(1, 50), std::invalid_argument);
}

}  // namespace mpm
