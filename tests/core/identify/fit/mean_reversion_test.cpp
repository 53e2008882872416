#include "core/identify/fit/mean_reversion.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <limits>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::mean_reversion_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kRows = 3000;
constexpr int kSeeds = 200;

/// Of so many walks or autoregressions, how many come back; `noise` on top.
int come_back(double pole, double noise) {
  int count = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const VectorXd signal = test::autoregressive(test::normal(500 + seed, kRows), pole) +
                            noise * test::normal(900 + seed, kRows);
    count += comes_back(signal) ? 1 : 0;
  }
  return count;
}

// The test's size is 5 %: of 200 walks 10 are expected to be called tame, more than 22 with a
// probability of 1e-4 (binomial).
TEST_CASE("a random walk does not come back, with noise on top or without") {
  CHECK(come_back(1.0, 0.0) <= 22);
  CHECK(come_back(1.0, 3.0) <= 22);
}

// A lag of 20 rows leaves neighbouring blocks of 30 with a correlation of 0.38, so that the
// coefficient lies some 6 s.d. below 0: of 200 all should be found.
TEST_CASE("noise that forgets comes back") {
  CHECK(come_back(0.0, 0.0) == kSeeds);
  CHECK(come_back(0.95, 0.0) >= kSeeds - 4);
}

/// Without the level and slope of both its parts, cut where that leaves least.
VectorXd without_best_cut(const VectorXd& signal) {
  const auto line_of = [](const VectorXd& part) {
    Eigen::MatrixXd columns(part.size(), 2);
    columns.col(0).setOnes();
    columns.col(1).setLinSpaced(-1.0, 1.0);
    return VectorXd(part - columns * columns.colPivHouseholderQr().solve(part));
  };
  VectorXd best = signal;
  for (Index cut = kRows / 10; cut < kRows * 9 / 10; cut += kRows / 20) {
    VectorXd left(kRows);
    left << line_of(signal.head(cut)), line_of(signal.tail(kRows - cut));
    if (left.squaredNorm() < best.squaredNorm()) best = left;
  }
  return best;
}

// Drawn in numpy 1 % of walks pass for what comes back: of 200 more than 8 with a probability of
// 3e-4. Of noise that forgets
// within a block the statistic is some -10, -6 at a lag of 20 rows.
TEST_CASE("a random walk does not come back for being cut in two") {
  int walks = 0, cut_by_the_usual_rule = 0, tame = 0, slow = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const VectorXd white = test::normal(1500 + seed, kRows);
    const VectorXd cut = without_best_cut(test::autoregressive(white, 1.0));
    walks += comes_back_beside_breaks(cut, 1) ? 1 : 0;
    cut_by_the_usual_rule += comes_back(cut) ? 1 : 0;
    tame += comes_back_beside_breaks(without_best_cut(white), 1) ? 1 : 0;
    slow +=
        comes_back_beside_breaks(without_best_cut(test::autoregressive(white, 0.95)), 1) ? 1 : 0;
  }
  CAPTURE(cut_by_the_usual_rule);
  CHECK(walks <= 8);
  CHECK(cut_by_the_usual_rule > 4 * walks);
  CHECK(tame == kSeeds);
  CHECK(slow >= kSeeds - 4);
}

// One in 1000: of 200 more than 3 with a probability of 6e-5.
TEST_CASE("hardly a random walk comes back by the stricter rule") {
  int walks = 0, under_noise = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const VectorXd walk = test::autoregressive(test::normal(1500 + seed, kRows), 1.0);
    walks += comes_back_beside_breaks(walk, 0) ? 1 : 0;
    under_noise += comes_back_beside_breaks(walk + 10.0 * test::normal(1900 + seed, kRows), 0);
  }
  CHECK(walks <= 3);
  CHECK(under_noise <= 3);
}

TEST_CASE("what stands still comes back, what is unknown is not taken for anything") {
  CHECK(comes_back(VectorXd::Constant(kRows, 3.0)));
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(comes_back(VectorXd::Constant(kRows, unknown)));
  VectorXd gaps = test::normal(1, kRows);
  gaps.head(kRows / 4).setConstant(unknown);
  CHECK(comes_back(gaps));
}

// A walk of so many rows is told from a CV that settles within a hundredth of them, and not from
// one that takes a tenth.
TEST_CASE("what is too short to tell wandering from settling does not wander") {
  const VectorXd walk = test::autoregressive(test::normal(500, kRows), 1.0);
  REQUIRE_FALSE(comes_back(walk));
  CHECK(wanders(walk, 0.01 * kRows));
  CHECK_FALSE(wanders(walk, 0.1 * kRows));
  CHECK_FALSE(wanders(test::normal(500, kRows), 0.01 * kRows));
}

}  // namespace
}  // namespace mpm::mean_reversion_test
