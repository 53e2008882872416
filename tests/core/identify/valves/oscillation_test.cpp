#include "core/identify/valves/oscillation.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::oscillation_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kPeriod = 40.0;

/// Rises through 0 at `zero`.
VectorXd sine(Index rows, double period, double zero = 0.0) {
  return VectorXd::NullaryExpr(rows, [&](Index k) {
    return std::sin(2.0 * M_PI * (static_cast<double>(k) - zero) / period);
  });
}

VectorXd line(Index rows, double slope) {
  return VectorXd::NullaryExpr(rows, [&](Index k) { return slope * static_cast<double>(k); });
}

}  // namespace

// The autocorrelation of a sine is a cosine of its period.
TEST_CASE("the period of a sine is found, on a line and in noise as well") {
  constexpr Index kRows = 2000;
  const VectorXd drifting = sine(kRows, kPeriod) + line(kRows, 0.05);
  const VectorXd noisy = sine(kRows, kPeriod) + 0.3 * test::normal(1, kRows);
  for (const VectorXd& values : {sine(kRows, kPeriod), drifting, noisy}) {
    const Oscillation found = oscillation_of(values);
    CHECK(found.period == Approx(kPeriod).epsilon(0.02));
    CHECK(found.regularity > 1.0);
  }
}

// Signs of the autocorrelation of white noise are drawn as heads and tails are: intervals of mean 2
// and s.d. sqrt(2), r = 2 / (3 sqrt(2)) = 0.47.
TEST_CASE("white noise does not swing regularly") {
  int regular = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed)
    regular += oscillation_of(test::normal(seed, 1000)).regularity > 1.0 ? 1 : 0;
  CHECK(regular <= 5);
}

TEST_CASE("a single swing has no period") {
  // Up to a lag of half a period its autocorrelation crosses 0 twice at most.
  const Oscillation found = oscillation_of(sine(400, 400.0));
  CHECK(found.period == 0.0);
  CHECK(found.regularity == 0.0);
}

TEST_CASE("the swing is what is left of a signal without its mean over a period") {
  constexpr Index kRows = 200;
  const VectorXd wave = sine(kRows, kPeriod);
  const VectorXd raised = wave.array() + 50.0;
  CHECK((swing_of(raised, kPeriod) - wave).cwiseAbs().maxCoeff() < 1e-10);

  // Of 40 rows from k - 20 on the mean is that at k - 0.5; at the ends, of the 40 rows there.
  const VectorXd swing = swing_of(line(kRows, 2.0), kPeriod);
  CHECK((swing.segment(20, kRows - 40).array() - 1.0).abs().maxCoeff() < 1e-10);
  CHECK(swing(0) == Approx(-39.0));
  CHECK(swing(kRows - 1) == Approx(39.0));

  // All there is, where that is less than a period: 1, 2, 6 less 3.
  CHECK(
      swing_of(Eigen::Vector3d(1.0, 2.0, 6.0), kPeriod).isApprox(Eigen::Vector3d(-2.0, -1.0, 3.0)));
}

TEST_CASE("half cycles lie between the zeros") {
  const VectorXd wave = sine(100, kPeriod, 5.5);  // zeros at 5.5, 25.5 .. 85.5
  const std::vector<HalfCycle> halves = half_cycles(wave, kPeriod);
  REQUIRE(halves.size() == 4);
  for (std::size_t i = 0; i < halves.size(); ++i) {
    CHECK(halves[i].begin == Approx(5.5 + 20.0 * static_cast<double>(i)));
    CHECK(halves[i].end == Approx(25.5 + 20.0 * static_cast<double>(i)));
  }
  // 20 samples are a whole period of 20 and a fifth of one of 100.
  CHECK(half_cycles(wave, 20.0).empty());
  CHECK(half_cycles(wave, 100.0).empty());
}

TEST_CASE("noise around zero makes no half cycles") {
  // By turns 0.1 above and below: within 1.5 samples of a zero it changes sign, within the level.
  VectorXd wave = sine(100, kPeriod, 5.5);
  for (Index k = 0; k < wave.size(); ++k) wave(k) += k % 2 == 0 ? 0.1 : -0.1;
  const std::vector<HalfCycle> halves = half_cycles(wave, kPeriod);
  REQUIRE(halves.size() == 4);
  for (const HalfCycle& half : halves) CHECK(half.end - half.begin == Approx(20.0).margin(3.0));
}

}  // namespace mpm::oscillation_test
