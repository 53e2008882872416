#include "core/mismatch/noise_level.hpp"

#include <catch2/catch.hpp>
#include <cmath>
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
  CHECK(begun(2.0).weigh({1.0, 0.0}, false) == Approx(0.5));
  CHECK(begun(2.0).weigh({6.0, 0.0}, false) == Approx(0.5));
  CHECK(begun(2.0).weigh({-20.0, 0.0}, false) == Approx(0.5 * 6.0 / 20.0));
  // Leverage 12 / s^2 = 3 makes the error's s.d. twice s: 12 is 3 of these.
  CHECK(begun(2.0).weigh({12.0, 12.0}, false) == Approx(0.5));
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

TEST_CASE("tails are presumed heavy until rows say otherwise") {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  std::student_t_distribution<double> heavy(2.5);
  NoiseLevel light = begun(1.0), wild = begun(1.0);
  CHECK(light.heavy_tails() == 1.0);
  for (int k = 0; k < 3000; ++k) {
    light.weigh({normal(random), 0.0}, false);
    wild.weigh({heavy(random), 0.0}, false);
  }
  // P(|z| > 3) = 0.0027 is below the share at which tails begin to count, 0.008.
  CHECK(light.clipped_share() < 0.008);
  CHECK(light.heavy_tails() == 0.0);
  CHECK(wild.heavy_tails() == 1.0);
  wild.restart(1.0);
  CHECK(wild.heavy_tails() == 0.0);
  CHECK(wild.surprise() == 1.0);
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
