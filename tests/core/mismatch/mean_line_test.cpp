#include "core/mismatch/mean_line.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/allocation_counter.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::mean_line_test {
namespace {

void run(LaggedCorrelation& correlation, int samples, bool silent) {
  Eigen::VectorXd u(2), e(3);
  for (int k = 0; k < samples; ++k) {
    for (int i = 0; i < 2; ++i) u(i) = test::coloured(static_cast<std::uint64_t>(10 + i), k);
    for (int j = 0; j < 3; ++j)
      e(j) =
          test::coloured(static_cast<std::uint64_t>(50 + j), k) + 0.4 * test::coloured(10, k - 2);
    if (silent) u(1) = 3.0;
    correlation.update(u, e);
  }
  correlation.evaluate();
}

TEST_CASE("the mean line is the mean magnitude over all channels and lags") {
  LaggedCorrelation correlation({2, 3, 6, -2, 4}, 0.995);
  run(correlation, 800, false);
  double sum = 0.0, largest = 0.0;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 3; ++j)
      for (int l = 0; l < 7; ++l) {
        sum += std::abs(correlation.correlations(j, i)(l));
        largest = std::max(largest, std::abs(correlation.correlations(j, i)(l)));
      }
  CHECK(mean_line(correlation) == Approx(sum / (2 * 3 * 7)).epsilon(1e-13));
  CHECK(mean_line(correlation) > 0.0);
  CHECK(mean_line(correlation) < largest);
}

TEST_CASE("a silent input does not lower the mean line") {
  LaggedCorrelation with({2, 3, 6, -2, 4}, 0.995);
  run(with, 800, true);
  REQUIRE_FALSE(with.defined(1));
  double sum = 0.0;
  for (int j = 0; j < 3; ++j) sum += with.correlations(j, 0).cwiseAbs().sum();
  CHECK(mean_line(with) == Approx(sum / (3 * 7)).epsilon(1e-13));
}

TEST_CASE("the mean line is 0 before anything is defined, and allocates nothing") {
  LaggedCorrelation correlation({2, 3, 6, -2, 4}, 0.995);
  CHECK(mean_line(correlation) == 0.0);
  run(correlation, 100, false);
  const std::uint64_t before = test::allocation_count();
  const double line = mean_line(correlation);
  const std::uint64_t after = test::allocation_count();
  CHECK(after == before);
  CHECK(line > 0.0);
}

}  // namespace
}  // namespace mpm::mean_line_test
