#include "core/performance/moments.hpp"

#include <catch2/catch.hpp>

namespace mpm {
namespace {

// By hand: 1, 2, 6 have the mean 3, squares about it of 4 + 1 + 9 and mean square 41 / 3.
TEST_CASE("moments are those of the values, at whatever level these lie") {
  Moments moments;
  for (const double value : {1.0, 2.0, 6.0}) moments.take(value);
  CHECK(moments.mean() == Approx(3.0));
  CHECK(moments.variance() == Approx(7.0));
  CHECK(moments.rms() == Approx(std::sqrt(41.0 / 3.0)));
  Moments high;
  for (const double value : {1.0, 2.0, 6.0}) high.take(1e9 + value);
  CHECK(high.variance() == Approx(7.0));
}

TEST_CASE("moments of two parts are those of the whole") {
  Moments first, second, all;
  for (int k = 0; k < 40; ++k) {
    const double value = 5.0 + 0.1 * k * k;
    (k < 7 ? first : second).take(value);
    all.take(value);
  }
  first.add(second);
  first.add(Moments());
  CHECK(first.count() == 40);
  CHECK(first.mean() == Approx(all.mean()).epsilon(1e-14));
  CHECK(first.variance() == Approx(all.variance()).epsilon(1e-12));
}

TEST_CASE("of too few values nothing is told") {
  Moments moments;
  CHECK(std::isnan(moments.mean()));
  CHECK(std::isnan(moments.rms()));
  moments.take(2.0);
  CHECK(moments.mean() == 2.0);
  CHECK(moments.rms() == 2.0);
  CHECK(std::isnan(moments.variance()));
}

}  // namespace
}  // namespace mpm
