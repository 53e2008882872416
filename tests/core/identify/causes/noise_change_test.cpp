#include "core/identify/causes/noise_change.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::noise_change_test {
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
    // What bursts there are by chance in 31 blocks widens it.
    const double widened = std::log(change->high / change->low) / (2.0 * 1.96 * sd);
    CHECK(widened > 0.85);
    CHECK(widened < 1.5);
    CHECK(change->z == Approx(std::log(change->ratio) / (widened * sd)).epsilon(0.01));
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

/// As a historian keeps it that writes a value only once it is `deadband` away from the last.
VectorXd compressed(const VectorXd& signal, double deadband) {
  VectorXd kept = signal;
  for (Index k = 1; k < kept.size(); ++k)
    if (std::abs(signal(k) - kept(k - 1)) < deadband) kept(k) = kept(k - 1);
  return kept;
}

bool is_named(const VectorXd& innovations) {
  const test::KnownCv cv = test::known_cv(innovations, VectorXd());
  const std::optional<NoiseChange> change = find_noise_change(cv.fit, cv.data);
  return change && change->beyond_doubt();
}

// Levels that are not independent: steady noise of which whole stretches are louder by chance,
// and steady noise with a slow part, of which a historian keeps what moves by 1.5 s.d.
TEST_CASE("bursts of steady noise are no change") {
  int bursts = 0, held = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const VectorXd slow = test::first_order(test::normal(1000 + seed, 2000), 1.0, 20.0);
    VectorXd louder = test::normal(seed, 2000);
    for (Index k = 0; k < 2000; ++k) louder(k) *= std::exp(5.0 * slow(k));
    if (is_named(louder)) ++bursts;
    const VectorXd kept = compressed(test::normal(3000 + seed, 2000) + 10.0 * slow, 1.5);
    if (is_named(kept)) ++held;
  }
  CHECK(bursts <= 6);
  CHECK(held <= 2);
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
}  // namespace mpm::noise_change_test
