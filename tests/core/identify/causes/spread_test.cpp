#include "core/identify/causes/spread.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace mpm::spread_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// 0 .. count - 1, each once, in no order.
VectorXd shuffled(Index count, Index stride) {
  return VectorXd::NullaryExpr(count,
                               [&](Index k) { return static_cast<double>((k * stride) % count); });
}

// By hand: of 0 .. 100 the 1 and 99 % quantiles are 1 and 99; the variance of n numbers in a row is
// (n^2 - 1) / 12.
TEST_CASE("a spread says where a signal mostly is") {
  const std::optional<Spread> spread = spread_of(shuffled(101, 37));
  REQUIRE(spread);
  CHECK(spread->low == 1.0);
  CHECK(spread->high == 99.0);
  CHECK(spread->range() == 98.0);
  CHECK(spread->median == 50.0);
  CHECK(spread->sd == Approx(std::sqrt((101.0 * 101.0 - 1.0) / 12.0)));
  CHECK(spread->quantile(0.0) == 0.0);
  CHECK(spread->quantile(0.25) == 25.0);
  CHECK(spread->quantile(1.0) == 100.0);
}

TEST_CASE("what is not known of a signal is not asked") {
  VectorXd values = VectorXd::Constant(150, kUnknown);
  values.segment(20, 101) = shuffled(101, 37);
  values(7) = std::numeric_limits<double>::infinity();
  const std::optional<Spread> spread = spread_of(values);
  REQUIRE(spread);
  CHECK(spread->sorted.size() == 101);
  CHECK(spread->median == 50.0);
  CHECK(spread->high == 99.0);
}

TEST_CASE("too few values, or some that hardly move, have no spread") {
  CHECK_FALSE(spread_of(shuffled(19, 7)));
  CHECK(spread_of(shuffled(20, 7)));
  CHECK_FALSE(spread_of(VectorXd::Constant(500, 4.0)));
  // One move in 500 rows is beyond the quantiles.
  VectorXd once = VectorXd::Constant(500, 4.0);
  once(250) = 9.0;
  CHECK_FALSE(spread_of(once));
  CHECK_FALSE(spread_of(VectorXd::Constant(100, kUnknown)));
}

TEST_CASE("a binary signal has two levels, however it began, and one of an MPC has many") {
  VectorXd binary = VectorXd::NullaryExpr(1000, [](Index k) {
    return k < 12 ? 0.0 : (k * 37) % 101 < 50 ? -1.0 : 1.0;
  });
  CHECK(spread_of(binary)->levels() == 2);
  VectorXd steps =
      VectorXd::NullaryExpr(1000, [](Index k) { return static_cast<double>(k / 250 % 3); });
  CHECK(spread_of(steps)->levels() == 3);
  CHECK(spread_of(shuffled(1001, 37))->levels() > 40);
}

}  // namespace
}  // namespace mpm::spread_test
