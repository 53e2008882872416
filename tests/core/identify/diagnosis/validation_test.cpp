#include "core/identify/diagnosis/validation.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::validation_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// By the delta method: s.d. of 1 - sqrt(N / O), N and O sums of `rows` independent pairs.
double gain_sd(const VectorXd& before, const VectorXd& after) {
  const auto rows = static_cast<double>(before.size());
  const double o = before.mean(), n = after.mean();
  const auto a = (before.array() - o) / o, b = (after.array() - n) / n;
  return 0.5 * std::sqrt(n / o) * std::sqrt((b - a).square().mean() / rows);
}

// By hand.
TEST_CASE("the mean of what is known, and 1 where that says nothing") {
  CHECK(mean_of_finite(Eigen::Vector4d(1.0, kUnknown, 5.0, 3.0)) == 3.0);
  CHECK(mean_of_finite(Eigen::Vector2d(0.0, 0.0)) == 1.0);
  CHECK(mean_of_finite(Eigen::Vector2d(kUnknown, kUnknown)) == 1.0);
  CHECK(mean_of_finite(VectorXd()) == 1.0);
}

// By hand: the measured values have the mean 2.5 and the s.d. sqrt(5) / 2.
TEST_CASE("errors and fits of two simulations") {
  const Eigen::Vector4d measured(1.0, 2.0, 3.0, 4.0);
  const CvScore result = score(measured, Eigen::Vector4d(3.0, 4.0, 5.0, 6.0),
                               Eigen::Vector4d(1.0, 2.0, 3.0, 5.0), 1, 1);
  CHECK(result.rmse_before == Approx(2.0));
  CHECK(result.rmse_after == Approx(0.5));
  CHECK(result.fit_before == Approx(100.0 * (1.0 - 2.0 / std::sqrt(1.25))));
  CHECK(result.fit_after == Approx(100.0 * (1.0 - 0.5 / std::sqrt(1.25))));
  CHECK(result.level_after == Approx(-0.25));
  CHECK_FALSE(result.refused);
}

TEST_CASE("rows that were not measured take no part in a score") {
  VectorXd measured(6), before = VectorXd::Zero(6), after = VectorXd::Zero(6);
  measured << 1.0, kUnknown, -1.0, 1.0, kUnknown, -1.0;
  before(1) = after(4) = 1e6;
  const CvScore result = score(measured, before, after, 1, 1);
  CHECK(result.level_after == 0.0);
  CHECK(result.rmse_before == 1.0);
  CHECK(result.rmse_after == 1.0);
  CHECK(result.fit_before == Approx(0.0).margin(1e-12));
}

// The quantiles of 500 resamples are known to 0.12 s.d. themselves: three of those.
TEST_CASE("the interval of the gain is that of the normal approximation") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    const VectorXd common = test::normal(2 * seed, 4000), own = test::normal(2 * seed + 1, 4000);
    const VectorXd before = (common + own).cwiseAbs2(), after = common.cwiseAbs2();
    const CvScore result = score_errors(before, after, 1, seed);
    const double gain = 1.0 - result.rmse_after / result.rmse_before;
    CHECK(result.rmse_before == Approx(std::sqrt(before.mean())));
    const double sd = gain_sd(before, after);
    CHECK(result.gain_low == Approx(gain - 1.96 * sd).margin(0.36 * sd));
    CHECK(result.gain_high == Approx(gain + 1.96 * sd).margin(0.36 * sd));
  }
}

// Errors that come in groups of g equal ones are 1/g as many: sqrt(g) times as wide an interval
// where the blocks are long enough, and the plain one where each row is a block.
TEST_CASE("errors that hang together widen the interval") {
  constexpr Index kGroup = 16, kRows = 8000;
  const VectorXd few = test::normal(50, kRows / kGroup), fewer = test::normal(51, kRows / kGroup);
  const auto spread = [&](const VectorXd& values) -> VectorXd {
    return VectorXd::NullaryExpr(kRows, [&](Index k) { return values(k / kGroup); });
  };
  const VectorXd before = spread((few + fewer).cwiseAbs2()), after = spread(few.cwiseAbs2());
  const double plain = 2.0 * 1.96 * gain_sd(before, after);
  const auto width = [&](Index block) {
    const CvScore result = score_errors(before, after, block, 3);
    return result.gain_high - result.gain_low;
  };
  CHECK(width(1) == Approx(plain).epsilon(0.2));
  CHECK(width(10 * kGroup) == Approx(plain * std::sqrt(double(kGroup))).epsilon(0.25));
}

TEST_CASE("the same seed gives the same interval, another one a like one") {
  const VectorXd before = test::normal(7, 1000).cwiseAbs2(),
                 after = test::normal(8, 1000).cwiseAbs2();
  const CvScore first = score_errors(before, after, 10, 1),
                again = score_errors(before, after, 10, 1),
                other = score_errors(before, after, 10, 2);
  CHECK(first.gain_low == again.gain_low);
  CHECK(first.gain_high == again.gain_high);
  CHECK(first.gain_low != other.gain_low);
  CHECK(first.gain_low == Approx(other.gain_low).margin(0.5 * (first.gain_high - first.gain_low)));
}

TEST_CASE("without errors there is nothing to gain") {
  const CvScore none = score_errors(VectorXd::Zero(100), VectorXd::Ones(100), 5, 1);
  CHECK(none.rmse_after == 1.0);
  CHECK(none.gain_low == 0.0);
  CHECK(none.gain_high == 0.0);
  CHECK(score_errors(VectorXd::Constant(3, kUnknown), VectorXd::Ones(3), 5, 1).rmse_before == 0.0);
  const CvScore same = score_errors(VectorXd::Ones(100), VectorXd::Constant(100, 0.25), 5, 1);
  CHECK(same.gain_low == Approx(0.5));  // every resample says the same
  CHECK(same.gain_high == Approx(0.5));
}

}  // namespace
}  // namespace mpm::validation_test
