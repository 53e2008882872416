#include "core/identify/fit/plateau.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// `rows` values that rise, the largest `top` of them cut to one, the smallest `bottom` likewise;
/// each of the others `repeats` times.
VectorXd clipped(Index rows, Index top, Index bottom = 0, Index repeats = 1) {
  VectorXd values = VectorXd::NullaryExpr(rows, [&](Index k) {
    const Index level = k / repeats;
    return static_cast<double>(level);
  });
  values.tail(top).setConstant(static_cast<double>(rows));
  values.head(bottom).setConstant(-1.0);
  return values;
}

/// The same values in another order, so that every level is come to from afar, again and again.
VectorXd mixed(const VectorXd& values) {
  VectorXd result(values.size());  // of which 7 is no divisor
  for (Index k = 0; k < values.size(); ++k) result((k * 7) % values.size()) = values(k);
  return result;
}

bool high(const VectorXd& values) { return find_plateaus(mixed(values)).high.has_value(); }

// The rule as it is written: at least 0.5 % of the samples, at least eight, five times as many as
// share any of the ten next values.
TEST_CASE("an end is a plateau from eight equal values on") {
  CHECK_FALSE(high(clipped(1000, 7)));
  CHECK(high(clipped(1000, 8)));
  CHECK_FALSE(find_plateaus(mixed(clipped(1000, 8))).low);
}

TEST_CASE("an end is a plateau from half a per cent on") {
  CHECK_FALSE(high(clipped(2000, 9)));
  CHECK(high(clipped(2000, 10)));
}

TEST_CASE("a coarse converter repeats all values, which is no plateau") {
  CHECK_FALSE(high(clipped(1000, 10, 0, 2)));  // five times as many, not more
  CHECK(high(clipped(1000, 11 + 1, 0, 2)));
  // Only the ten next to the end are asked.
  VectorXd values = clipped(1000, 12);
  values.segment(500, 40).setConstant(500.5);
  CHECK(high(values));
  values.segment(980, 3).setConstant(980.5);
  CHECK_FALSE(high(values));
}

TEST_CASE("levels and shares of both ends, in any order of the rows and with unknown ones") {
  VectorXd values = clipped(1000, 20, 30);
  VectorXd with_unknown(1003);
  with_unknown.head(1000) = mixed(values);
  with_unknown.tail(3).setConstant(std::numeric_limits<double>::quiet_NaN());
  const Plateaus plateaus = find_plateaus(with_unknown);
  REQUIRE(plateaus.low);
  REQUIRE(plateaus.high);
  CHECK(*plateaus.low == -1.0);
  CHECK(*plateaus.high == 1000.0);
  CHECK(plateaus.low_share == Approx(0.03));
  CHECK(plateaus.high_share == Approx(0.02));
}

TEST_CASE("a CV that rests at an end, or goes there once, does not clip") {
  const VectorXd once = clipped(1000, 20, 30);
  CHECK_FALSE(find_plateaus(once).low);
  CHECK_FALSE(find_plateaus(once).high);
  VectorXd dithers = once;  // about the end, without leaving it
  for (Index k = 980; k < 1000; k += 2) dithers(k) = 999.5;
  CHECK_FALSE(find_plateaus(dithers).high);
}

TEST_CASE("noise, a signal of two levels and a short recording have no plateau") {
  const auto none = [](const VectorXd& values) {
    const Plateaus plateaus = find_plateaus(values);
    return !plateaus.low && !plateaus.high;
  };
  CHECK(none(test::white(1, 3000)));
  CHECK(none(test::telegraph(1, 1000, 10)));
  CHECK(none(clipped(99, 20)));
  CHECK(none(VectorXd::Constant(1000, 4.0)));
}

}  // namespace
}  // namespace mpm
