#include "core/identify/causes/noise_change.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// White normal noise, from `onset` on `sd_ratio` times as loud.
test::KnownCv noise(std::uint64_t seed, Index rows, Index onset, double sd_ratio) {
  VectorXd innovations = test::normal(seed, rows);
  innovations.tail(rows - onset) *= sd_ratio;
  return test::known_cv(innovations, VectorXd());
}

// Twice the s.d. is four times the variance. The log of a normal variable's square has the variance
// pi^2 / 2, so that the log of the ratio is known to pi / sqrt(2) sqrt(1/600 + 1/400).
TEST_CASE("a lasting change of the noise is dated and measured") {
  const double sd = M_PI / std::sqrt(2.0) * std::sqrt(1.0 / 600.0 + 1.0 / 400.0);
  int inside = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    const test::KnownCv cv = noise(seed, 1000, 600, 2.0);
    const std::optional<NoiseChange> change = find_noise_change(cv.fit, cv.data);
    REQUIRE(change);
    CHECK(std::abs(change->onset - 600) <= 60);
    CHECK(std::abs(std::log(change->ratio / 4.0)) < 4.5 * sd);
    CHECK(std::log(change->high / change->low) == Approx(2.0 * 1.96 * sd).epsilon(0.15));
    CHECK(change->z == Approx(std::log(change->ratio) / sd).epsilon(0.25));
    if (change->low < 4.0 && 4.0 < change->high) ++inside;
  }
  // 95 of 100 +- 2.2; the moment is picked, which costs a little.
  CHECK(inside >= 86);
}

TEST_CASE("noise that becomes quieter is a change too") {
  const test::KnownCv cv = noise(3, 1500, 500, 0.5);
  const std::optional<NoiseChange> change = find_noise_change(cv.fit, cv.data);
  REQUIRE(change);
  CHECK(change->z < 0.0);
  CHECK(change->low < 0.25);
  CHECK(change->high > 0.25);
  CHECK(std::abs(change->onset - 500) <= 60);
}

// The bound is held by all but 1 of 1000 recordings or so.
TEST_CASE("steady noise does not change") {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const test::KnownCv normal = noise(seed, 1000, 500, 1.0);
    if (find_noise_change(normal.fit, normal.data, 1.0)) ++alarms;
    const test::KnownCv uniform = test::known_cv(test::white(seed, 1000), VectorXd());
    if (find_noise_change(uniform.fit, uniform.data, 1.0)) ++alarms;
  }
  CHECK(alarms <= 2);
}

TEST_CASE("a change that is certain but small is left alone") {
  const test::KnownCv cv = noise(5, 8000, 4000, std::sqrt(1.4));
  CHECK_FALSE(find_noise_change(cv.fit, cv.data));
  const std::optional<NoiseChange> change = find_noise_change(cv.fit, cv.data, 1.2);
  REQUIRE(change);
  CHECK(change->low < 1.4);
  CHECK(change->high > 1.4);
}

TEST_CASE("rows without a weight are not asked, and too few rows say nothing") {
  test::KnownCv cv = noise(7, 1000, 600, 2.0);
  cv.data.weights.tail(400).setZero();
  CHECK_FALSE(find_noise_change(cv.fit, cv.data));
  const test::KnownCv short_one = noise(8, 199, 100, 5.0);
  CHECK_FALSE(find_noise_change(short_one.fit, short_one.data));
  const test::KnownCv enough = noise(8, 200, 100, 5.0);
  CHECK(find_noise_change(enough.fit, enough.data));
}

}  // namespace
}  // namespace mpm
