#include "core/statistics/normal.hpp"

#include <boost/math/distributions/normal.hpp>
#include <catch2/catch.hpp>

namespace mpm {
namespace {

TEST_CASE("normal quantiles are right to the digits that are written") {
  const boost::math::normal normal;
  CHECK(kNormalTwoSided95 == Approx(boost::math::quantile(normal, 0.975)).margin(0.005));
  CHECK(kNormalOneSided95 == Approx(boost::math::quantile(normal, 0.95)).margin(0.0005));
  CHECK(kNormalOneSided99 == Approx(boost::math::quantile(normal, 0.99)).margin(0.0005));
}

}  // namespace
}  // namespace mpm
