#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/mismatch/calibration.hpp"
#include "core/monitor/calibration.hpp"
#include "core/monitor/settings.hpp"

namespace mpm {
namespace {

// What calibration.hpp calls derived, derived again.

TEST_CASE("an error that counts as visible is seen with the power that is claimed") {
  constexpr double kFreedom = 6.0, kLevel = 0.01 / 9.0;
  const double seen = calibration::visibility::kSeenDeviations;
  const double critical =
      boost::math::quantile(boost::math::complement(boost::math::chi_squared(kFreedom), kLevel));
  const boost::math::non_central_chi_squared shifted(kFreedom, seen * seen);
  CHECK(boost::math::cdf(boost::math::complement(shifted, critical)) == Approx(0.94).margin(0.005));
}

TEST_CASE("after the settling time less than 1 % is left of a wrong start") {
  CHECK(std::exp(-calibration::simulation::kSettlingTimeConstants) < 0.01);
  CHECK(std::exp(-calibration::usual_errors::kTailFitTimeConstants) < 0.0005);
}

TEST_CASE("limits that depend on each other are in order") {
  const AlarmSettings alarms;
  CHECK(alarms.raise_p_value < alarms.clear_p_value);
  CHECK(calibration::change_search::kCertainPValue < calibration::change_search::kSuspiciousPValue);
  CHECK(calibration::change_search::kSuspiciousSurprise <
        calibration::change_search::kUrgentSurprise);
  CHECK(calibration::heavy_tails::kFromShare < calibration::heavy_tails::kFullShare);
  CHECK(calibration::row_weights::kClip < calibration::row_weights::kLenientClip);
  // A memory that may speak holds fewer rows than it is long.
  CHECK(calibration::rows_needed::kPerColumn < calibration::memories::kFastRowsPerColumn);
}

}  // namespace
}  // namespace mpm
