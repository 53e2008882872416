#include "tests/calibrate/refit.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/mismatch/calibration.hpp"

namespace mpm::calibrate {
namespace {

namespace few_rows = calibration::few_rows;

/// F with 4 and 40 degrees of freedom as the ratio of two mean squares, times 1 + factor 10 / 40
/// and the square's part: what a test on a regression of 10 columns and 50 rows gives whose factor
/// is `factor`.
std::vector<Run> runs_with(double factor, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::chi_squared_distribution<double> numerator(4.0);
  std::chi_squared_distribution<double> denominator(40.0);
  std::vector<Run> runs(400);
  for (Run& run : runs)
    for (int channel = 0; channel < 9; ++channel)
      run.readings.push_back(
          {.rows_per_column = 5,
           .directed = numerator(random) / 4.0 / (denominator(random) / 40.0) *
                       (1.0 + factor * 0.25 + few_rows::kDirectedSquare * 0.0625),
           .directed_freedom = 4,
           .block = numerator(random) / 4.0 / (denominator(random) / 40.0) *
                    (1.0 + few_rows::kBlockSquare * 0.0625),
           .block_freedom = 4,
           .columns_per_freedom = 0.25,
           .freedom = 40.0});
  return runs;
}

// Ten fits: an interval of 95 % misses four or more of ten in 1 of 1000 sets of seeds.
TEST_CASE("a hidden factor for few rows is found within its interval") {
  int directed = 0;
  int block = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::vector<Run> runs = runs_with(2.0, seed);
    const Refit found = refit_few_rows(runs, Test::kDirected, 5, 10);
    const Refit none = refit_few_rows(runs, Test::kBlock, 5, 10);
    directed += found.low < 2.0 && 2.0 < found.high ? 1 : 0;
    block += none.low < 0.0 && 0.0 < none.high ? 1 : 0;
    CHECK(found.high - found.low < 1.0);
  }
  CHECK(directed >= 7);
  CHECK(block >= 7);
}

TEST_CASE("only a factor that asks for too little is too lax") {
  const Refit lax = refit_few_rows(runs_with(4.0, 1), Test::kDirected, 5, 10);
  CHECK(lax.now == calibration::few_rows::kDirected);
  CHECK(lax.too_lax());
  CHECK_FALSE(refit_few_rows(runs_with(0.0, 1), Test::kDirected, 5, 10).too_lax());
}

TEST_CASE("tails that count as heavy too late are too lax, too early are not") {
  Refit refit;
  refit.fitted = 0.02;
  refit.low = 0.019;
  refit.high = 0.021;
  refit.larger_is_stricter = false;
  refit.now = 0.015;
  CHECK_FALSE(refit.too_lax());
  refit.now = 0.0215;
  CHECK_FALSE(refit.too_lax());
  refit.now = 0.0225;
  CHECK(refit.too_lax());
}

TEST_CASE("rows are needed up to the last that give small p-values too often") {
  std::vector<Run> runs(100);
  for (Run& run : runs)
    for (const int rows : kRowsPerColumn)  // below 8 rows per column F is far out in all readings
      run.readings.push_back({.rows_per_column = rows,
                              .block = rows < 8 ? 100.0 : 1.0,
                              .block_freedom = 4,
                              .columns_per_freedom = 0.25,
                              .freedom = 40.0});
  CHECK(refit_rows_needed(runs, 1e-3, 2.0).fitted == 8.0);
  for (Run& run : runs) run.readings.back().block = 100.0;
  CHECK(refit_rows_needed(runs, 1e-3, 2.0).fitted > 1e9);  // none of them will do
}

TEST_CASE("a quantile of clipped shares is that of all CVs") {
  std::vector<Run> runs(101);
  for (std::size_t k = 0; k < runs.size(); ++k) runs[k].clipped_shares = {static_cast<double>(k)};
  CHECK(refit_clipped_share(runs, 0.99).fitted == 99.0);
}

}  // namespace
}  // namespace mpm::calibrate
