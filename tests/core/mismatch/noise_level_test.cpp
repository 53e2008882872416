#include "core/mismatch/noise_level.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

namespace mpm {
namespace {

NoiseLevel begun(double scale) {
  NoiseLevel noise;
  noise.begin(scale * scale, 1000.0);
  return noise;
}

TEST_CASE("a row weighs as its own error in units of the noise says") {
  // min(1, 3 s / |r|) / s with s = 2.
  CHECK(begun(2.0).weigh({1.0, 0.0}, false).weight == Approx(0.5));
  CHECK(begun(2.0).weigh({6.0, 0.0}, false).weight == Approx(0.5));
  CHECK(begun(2.0).weigh({-20.0, 0.0}, false).weight == Approx(0.5 * 6.0 / 20.0));
  // Leverage 5 / s^2 = 1.25 makes the error's s.d. 1.5 s: 9 is 3 of these.
  CHECK(begun(2.0).weigh({9.0, 5.0}, false).weight == Approx(0.5));
}

// P(|z| > 3) = 0.0027 is below the share at which tails begin to count, 0.008; of t(2.5) in units
// of the level that is followed more than 0.02 is beyond 3.
TEST_CASE("rows tell whether tails are heavy") {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  std::student_t_distribution<double> heavy(2.5);
  NoiseLevel light = begun(1.0), wild = begun(1.0);
  CHECK(light.heavy_tails() == 0.0);
  for (int k = 0; k < 3000; ++k) {
    light.weigh({normal(random), 0.0}, false);
    wild.weigh({heavy(random), 0.0}, false);
  }
  CHECK(light.heavy_tails() == 0.0);
  CHECK(wild.heavy_tails() == 1.0);
  wild.restart(1.0, 0.014);
  CHECK(wild.heavy_tails() == Approx(0.5));
  CHECK(wild.surprise() == 1.0);
}

// What a wrong model does to the rows behind a move is no sign of heavy tails.
TEST_CASE("rows that say much do not tell of tails") {
  NoiseLevel noise = begun(1.0);
  for (int k = 0; k < 100; ++k) noise.weigh({50.0, 1e6}, false);
  CHECK(noise.heavy_tails() == 0.0);
  for (int k = 0; k < 100; ++k) noise.weigh({50.0, 0.0}, false);
  CHECK(noise.heavy_tails() == 1.0);
}

TEST_CASE("each row counts whole where no bound is asked for") {
  NoiseLevel noise(false);
  noise.begin(1.0, 1000.0);
  noise.restart(1.0, 1.0);
  CHECK(noise.heavy_tails() == 1.0);
  CHECK(noise.weigh({0.0, 100.0}, false).share == 1.0);
}

TEST_CASE("where tails are heavy a row that says much counts for part of one, whatever it says") {
  const auto weigh = [](double clipped_share, double error, double leverage) {
    NoiseLevel noise = begun(2.0);
    noise.restart(2.0, clipped_share);
    return noise.weigh({error, 4.0 * leverage}, false);  // s^2 = 4
  };
  for (const double error : {0.0, 2.0, -8.0}) {
    const double clip = std::min(1.0, 3.0 * std::sqrt(33.0) / std::max(std::abs(error) / 2.0, 0.1));
    CHECK(weigh(0.003, error, 32.0).share == 1.0);  // as normal noise
    CHECK(weigh(0.003, error, 32.0).weight == Approx(0.5 * clip));
    CHECK(weigh(0.02, error, 2.0).share == 1.0);
    CHECK(weigh(0.02, error, 32.0).share == Approx(2.0 / 32.0));
    CHECK(weigh(0.02, error, 32.0).weight == Approx(0.5 * clip * std::sqrt(2.0 / 32.0)));
    CHECK(weigh(0.014, error, 32.0).share == Approx(2.0 / 16.0));  // half as heavy
  }
  // In a direction never seen it would be believed whatever it says, and yet is all that is known.
  CHECK(weigh(0.02, 1.0, std::numeric_limits<double>::infinity()).share == 0.02);
  CHECK(weigh(0.003, 1.0, std::numeric_limits<double>::infinity()).share == 1.0);
}

TEST_CASE("the level follows noise that trebles, and tells of it") {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  NoiseLevel noise = begun(1.0);
  for (int k = 0; k < 3000; ++k) noise.weigh({normal(random), 0.0}, false);
  // Normal noise clipped at 3 s.d. has a s.d. of 0.995; the estimate over 300 rows a s.d. of 0.03.
  CHECK(noise.scale() == Approx(1.0).margin(0.12));
  CHECK(noise.surprise() == Approx(1.0).margin(0.5));
  for (int k = 0; k < 100; ++k) noise.weigh({3.0 * normal(random), 0.0}, false);
  CHECK(noise.surprise() > 2.0);
  for (int k = 0; k < 2900; ++k) noise.weigh({3.0 * normal(random), 0.0}, false);
  CHECK(noise.scale() == Approx(3.0).margin(0.36));
}

TEST_CASE("a row of a direction hardly seen says nothing of the noise where rows come together") {
  NoiseLevel noise = begun(1.0);
  noise.weigh({50.0, 2.0}, true);
  CHECK(noise.scale() == 1.0);
  noise.weigh({50.0, 2.0}, false);
  CHECK(noise.scale() > 1.0);
}

}  // namespace
}  // namespace mpm
