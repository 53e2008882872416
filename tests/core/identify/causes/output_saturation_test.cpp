#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/proposals.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::output_saturation_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kRows = 400;

/// A CV that is cut off at these levels.
std::vector<Effect> shown(double low, double high) {
  const VectorXd u = test::telegraph(1, kRows, 12);
  const VectorXd cv = test::first_order(u, 2.0, 10.0) + 0.1 * test::white(2, kRows);
  const Recording recording = test::recording_of(u, cv.cwiseMax(low).cwiseMin(high));
  const Problem problem(test::model_of({test::lag(0, 0, 2.0, 10.0)}, 1, 1), 1, recording,
                        Tolerances{}, NoiseModel{});
  return causes::output_saturation().shown_by(problem);
}

const Quantity& level(const char* name) {
  return test::quantity_of(causes::output_saturation(), name);
}

TEST_CASE("the levels at which a sensor clips are certain, and told to the last digit") {
  const std::vector<Effect> upper = shown(-100.0, 1.5);
  REQUIRE(upper.size() == 1);
  CHECK(subject_of(upper[0]) == Subject{&causes::output_saturation(), {0}});
  CHECK(upper[0].certain);
  REQUIRE(upper[0].coordinates.size() == 1);
  CHECK(upper[0].value(level("high"), 0.0) == 1.5);

  const std::vector<Effect> both = shown(-1.25, 1.5);
  REQUIRE(both.size() == 1);
  REQUIRE(both[0].coordinates.size() == 2);
  CHECK(both[0].value(level("low"), 0.0) == -1.25);
  CHECK(both[0].value(level("high"), 0.0) == 1.5);
}

TEST_CASE("a sensor that does not clip shows nothing") { CHECK(shown(-100.0, 100.0).empty()); }

/// Whether a stop at 1 is ruled out for a CV that does this.
bool ruled_out(const VectorXd& cv) {
  const Recording recording = test::recording_of(test::telegraph(1, kRows, 12), cv);
  const Problem problem(test::model_of({test::lag(0, 0, 2.0, 10.0)}, 1, 1), 1, recording,
                        Tolerances{}, NoiseModel{});
  const Effect stop{&causes::output_saturation(), {0}, {{&level("high"), 1.0}}};
  return causes::output_saturation().contradicted(stop, problem);
}

TEST_CASE(
    "a CV that goes its way beyond a level does not stop there, one that shakes about it may") {
  const VectorXd free = test::first_order(test::telegraph(1, kRows, 12), 2.0, 10.0);
  CHECK(ruled_out(free + 0.02 * test::white(2, kRows)));
  CHECK_FALSE(ruled_out(free.cwiseMin(1.0) + 0.1 * test::white(2, kRows)));
  CHECK_FALSE(ruled_out(free.cwiseMin(0.9)));  // nothing beyond
}

}  // namespace
}  // namespace mpm::output_saturation_test
