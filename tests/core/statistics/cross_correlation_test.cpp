#include "core/statistics/cross_correlation.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/white_noise.hpp"

namespace mpm::test {
namespace {

TEST_CASE("the cross-correlation shows when a residual follows an input, and only then") {
  const std::vector<double> shocks = white(6'000, 5), noise = white(6'000, 6);
  std::vector<double> input(shocks.size()), residual(shocks.size());
  for (std::size_t k = 1; k < input.size(); ++k) input[k] = 0.9 * input[k - 1] + shocks[k];
  for (std::size_t k = 0; k < input.size(); ++k)
    residual[k] = noise[k] + (k >= 4 ? 0.5 * input[k - 4] : 0.0);
  residual[2'000] = std::nan("");
  const CrossCorrelation result = cross_correlation(input, residual, -10, 20);
  REQUIRE(result.values.size() == 31);
  CHECK(result.bound == Approx(2.0 / std::sqrt(6'000.0)).epsilon(0.02));
  int beyond = 0;
  for (int lag = -10; lag <= 20; ++lag) {
    const double value = result.values[static_cast<std::size_t>(lag + 10)];
    if (lag == 4)
      CHECK(value > 8.0 * result.bound);
    else
      beyond += std::abs(value) > result.bound ? 1 : 0;
  }
  CHECK(beyond <= 5);
  CHECK(cross_correlation(std::vector<double>(500, 2.0), noise, 0, 5).values.empty());
}

}  // namespace
}  // namespace mpm::test
