#include "core/monitor/f_thresholds.hpp"

#include <boost/math/distributions/fisher_f.hpp>
#include <catch2/catch.hpp>

#include "tests/allocation_counter.hpp"

namespace mpm {
namespace {

double quantile(double level, double numerator, double denominator) {
  return boost::math::quantile(
      boost::math::complement(boost::math::fisher_f(numerator, denominator), level));
}

TEST_CASE("thresholds are quantiles, kept while the degrees of freedom hardly change") {
  FThresholds thresholds;
  CHECK(thresholds.at(0.0, 100.0, 2, 0.01) == 0.0);
  CHECK(thresholds.at(5.0, 400.0, 2, 0.01) == Approx(quantile(0.005, 5.0, 400.0)).epsilon(1e-9));
  CHECK(thresholds.at(22.0, 400.0, 1, 0.01) == Approx(quantile(0.01, 22.0, 400.0)).epsilon(1e-9));
  const std::uint64_t before = test::allocation_count();
  CHECK(thresholds.at(5.0, 403.0, 2, 0.01) == thresholds.at(5.0, 400.0, 2, 0.01));
  CHECK(thresholds.at(5.0, 500.0, 2, 0.01) == Approx(quantile(0.005, 5.0, 500.0)).epsilon(1e-9));
  CHECK(test::allocation_count() == before);
}

}  // namespace
}  // namespace mpm
