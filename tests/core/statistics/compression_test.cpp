#include "core/statistics/compression.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/core/white_noise.hpp"

namespace mpm::compression_test {
namespace {

constexpr int kSamples = 6000;

/// A CV about 50 with noise of s.d. 1, of which `colour` carries over to the next sample.
std::vector<double> measured(double colour, unsigned seed) {
  std::vector<double> values = test::white(kSamples, seed);
  double last = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    double& value = values[static_cast<std::size_t>(k)];
    last = colour * last + std::sqrt(1.0 - colour * colour) * value;
    value = 50.0 + std::sin(0.003 * k) + last;
  }
  return values;
}

/// Of a resolution that is no round number, written with four decimals.
std::vector<double> quantised(std::vector<double> values, double step) {
  for (double& value : values) value = 1e-4 * std::round(1e4 * step * std::round(value / step));
  return values;
}

/// Sent only once it has left the deadband, held in between.
std::vector<double> held(std::vector<double> values, double deadband) {
  for (std::size_t k = 1; k < values.size(); ++k)
    if (std::abs(values[k] - values[k - 1]) <= deadband) values[k] = values[k - 1];
  return values;
}

/// Straight lines between the values that a deadband lets through, in single precision.
std::vector<double> interpolated(const std::vector<double>& values, double deadband) {
  const std::vector<double> kept = held(values, deadband);
  std::vector<double> lines = kept;
  std::size_t from = 0;
  for (std::size_t k = 1; k < kept.size(); ++k) {
    if (kept[k] == kept[k - 1]) continue;
    for (std::size_t i = from + 1; i < k; ++i)
      lines[i] = kept[from] + (kept[k] - kept[from]) * static_cast<double>(i - from) /
                                  static_cast<double>(k - from);
    from = k;
  }
  for (double& value : lines) value = static_cast<double>(static_cast<float>(value));
  return lines;
}

/// In how many of the samples the signal counts as compressed.
double found_share(const std::vector<double>& values) {
  Compression compression;
  int found = 0;
  for (const double value : values) {
    compression.take(value);
    found += compression.kind() != Compression::Kind::kNone ? 1 : 0;
  }
  return found / static_cast<double>(values.size());
}

// What each does to a signal is known by construction. Of 6000 samples the first thousand or so
// pass before it can be told.
TEST_CASE("values held by a deadband are known to be compressed, also of a coarse sensor") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    for (const double colour : {0.0, 0.7}) {
      const std::vector<double> raw = measured(colour, seed);
      CAPTURE(seed, colour);
      for (const double deadband : {0.3, 0.5, 1.0, 2.5}) {
        CHECK(found_share(held(raw, deadband)) > 0.6);
        CHECK(found_share(held(quantised(raw, 0.217), deadband + 0.11)) > 0.6);
      }
    }
  }
}

TEST_CASE("straight lines between the values that were kept are known to be compressed") {
  for (unsigned seed = 1; seed <= 20; ++seed)
    for (const double deadband : {1.0, 2.0, 3.0}) {
      CAPTURE(seed, deadband);
      CHECK(found_share(interpolated(measured(0.7, seed), deadband)) > 0.4);
    }
}

// 10 batches or more in each of 480 signals.
TEST_CASE("what no historian has compressed is not said to be") {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    for (const double colour : {0.0, 0.9}) {
      const std::vector<double> raw = measured(colour, seed);
      CAPTURE(seed, colour);
      CHECK(found_share(raw) == 0.0);
      for (const double step : {0.1057, 0.3, 0.717, 1.03, 2.0}) {
        CAPTURE(step);
        CHECK(found_share(quantised(raw, step)) == 0.0);
      }
    }
  }
}

TEST_CASE(
    "a stuck sensor, a resting one that jumps, and a slow noise-free one are not compressed") {
  const std::vector<double> raw = measured(0.7, 1);
  std::vector<double> stuck = raw, jumping(raw.size()), slow(raw.size());
  double goal = 0.0, level = 0.0;
  for (std::size_t k = 0; k < raw.size(); ++k) {
    if (k > 0 && k % 300 < 60) stuck[k] = stuck[k - 1];
    jumping[k] = k % 40 < 10 ? std::round(raw[k]) : 50.0;
    if (k % 100 == 0) goal = raw[k];
    level += (goal - level) / 30.0;
    slow[k] = level;
  }
  CHECK(found_share(stuck) == 0.0);
  CHECK(found_share(jumping) == 0.0);
  CHECK(found_share(slow) == 0.0);
}

// Of 30 normal changes none is below half the median one in 1 of 10 000 batches; of these there are
// 5 to 15 in each of 160 signals.
TEST_CASE("what is read now and then is not compressed") {
  for (unsigned seed = 1; seed <= 20; ++seed)
    for (const double colour : {0.0, 0.9})
      for (const std::size_t every : {2u, 5u, 10u, 40u}) {
        CAPTURE(seed, colour, every);
        const std::vector<double> raw = measured(colour, seed);
        std::vector<double> read = raw;
        for (std::size_t k = 0; k < read.size(); ++k) read[k] = raw[k - k % every];
        CHECK(found_share(read) == 0.0);
      }
}

TEST_CASE("a test signal is not compressed, though it rests and never moves by little") {
  for (unsigned seed = 1; seed <= 20; ++seed)
    for (const int levels : {2, 3, 7}) {
      CAPTURE(seed, levels);
      const std::vector<double> dice = test::white(kSamples, seed);
      std::vector<double> moved(dice.size(), 0.0);  // first from its home to a level
      for (std::size_t k = 1; k < moved.size(); ++k) {
        const int level = static_cast<int>(std::abs(dice[k]) * 1e6) % levels;
        const double to = 2.0 * level / (levels - 1) - 1.0;
        moved[k] = k % 10 == 0 ? to : moved[k - 1];
      }
      CHECK(found_share(moved) == 0.0);
    }
}

}  // namespace
}  // namespace mpm::compression_test
