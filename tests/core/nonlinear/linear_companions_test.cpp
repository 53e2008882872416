#include "core/nonlinear/linear_companions.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/allocation_counter.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm {

TEST_CASE("companions are means of twice the slowest tail, half of it and a quarter") {
  // Tail 40, six lags: 80, 20, 10, 5; not 40, which the regression has, and none below three.
  const RegressionShape shape{1, 1, 6, 2, {std::exp(-1.0 / 40.0)}};
  LinearCompanions companions(shape, 5);
  REQUIRE(companions.columns() == 4);
  RegressionHistory history(shape, 50);
  Eigen::VectorXd u(1), e = Eigen::VectorXd::Zero(1);
  u(0) = 3.0;
  history.push(u, e);
  companions.begin(history);
  std::vector<double> means(4, 0.0);
  std::vector<double> row(4);
  // By their recursion, from rest at the first value; a row sees what came before its sample.
  std::vector<std::vector<double>> expected;
  for (int k = 0; k < 60; ++k) {
    u(0) = 3.0 + test::uniform(1, k);
    history.push(u, e);
    const std::uint64_t before = test::allocation_count();
    companions.advance(history, 0);
    CHECK(test::allocation_count() == before);
    expected.push_back(means);
    for (std::size_t t = 0; t < 4; ++t) {
      const double pole = std::exp(-1.0 / std::vector{80.0, 20.0, 10.0, 5.0}[t]);
      means[t] = pole * means[t] + (1.0 - pole) * (u(0) - 3.0);
    }
  }
  for (const int age : {0, 3}) {
    companions.fill(age, row.data());
    for (std::size_t t = 0; t < 4; ++t)
      CHECK(row[t] == Approx(expected[static_cast<std::size_t>(59 - age)][t]));
  }
}

}  // namespace mpm
