#include "core/identify/search/odds.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::odds_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

CvFit with_innovations(const VectorXd& innovations, double variance) {
  CvFit fit;
  fit.innovations = innovations;
  fit.variance = variance;
  return fit;
}

/// `run` rows of +1, as many of -1, and so on.
VectorXd runs(Index rows, Index run) {
  return VectorXd::NullaryExpr(rows, [&](Index k) { return (k / run) % 2 == 0 ? 1.0 : -1.0; });
}

// A first-order correlation r leaves (1 - r) / (1 + r) of the rows. Runs of three: neighbours agree
// twice and differ once in three, so r = 1/3 and half the rows count.
TEST_CASE("innovations that hang together count as fewer") {
  const Index rows = 30000;
  CHECK(independence({with_innovations(runs(rows, 3), 1.0)}) == Approx(0.5).epsilon(1e-3));
  CHECK(independence({with_innovations(runs(rows, 4), 1.0)}) == Approx(1.0 / 3.0).epsilon(1e-3));
  // The scale is nothing to it.
  CHECK(independence({with_innovations(10.0 * runs(rows, 3), 100.0)}) == Approx(0.5).epsilon(1e-3));
  // No credit for rows that alternate, none taken for less than a tenth.
  CHECK(independence({with_innovations(runs(rows, 1), 1.0)}) == 1.0);
  CHECK(independence({with_innovations(test::white(1, rows), 1.0)}) == 1.0);
  // Two CVs of as many rows: the mean of 1/3 and 0.
  CHECK(independence({with_innovations(runs(rows, 3), 1.0),
                      with_innovations(runs(rows, 2), 1.0)}) == Approx(5.0 / 7.0).epsilon(1e-3));
  CHECK(independence({with_innovations(VectorXd::Zero(10), 1.0)}) == 1.0);
}

// 40 in the misfit, less 7 that the cause costs more, less the search, less 2 ln 12.
TEST_CASE("the odds for an effect are what it saves less what it costs") {
  Effect effect;
  effect.edit = &causes::stiction();
  effect.place = {-1, 0};
  effect.search_cost = 5.0;
  Fit with, without;
  with.cvs = without.cvs = {with_innovations(test::white(2, 1000), 1.0)};
  without.misfit = 100.0, with.misfit = 60.0;
  without.complexity = 3.0, with.complexity = 10.0;
  without.cost = 103.0, with.cost = 75.0;
  CHECK(odds_for(effect, with, without) == Approx(40.0 - 7.0 - 5.0 - 2.0 * std::log(12.0)));
  with.cvs = {with_innovations(runs(30000, 3), 1.0)};
  CHECK(odds_for(effect, with, without) ==
        Approx(20.0 - 7.0 - 5.0 - 2.0 * std::log(12.0)).margin(0.02));
  with.cost = std::numeric_limits<double>::infinity();
  CHECK(odds_for(effect, with, without) < -1e100);
}

}  // namespace
}  // namespace mpm::odds_test
