#include "core/identification/test_plan.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/core/identification/loop.hpp"

namespace mpm::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST_CASE("an input that stands still is planned a test of its size and length") {
  Recording recording = open_loop(2000, 840);
  recording.inputs.col(1).setConstant(5.0);
  const Identification found = identify(recording, {});
  CHECK(answer_of(found, 1, 1).left_out == LeftOut::kStill);
  TestLimits limits;
  limits.inputs.resize(3);
  limits.inputs[1] = {0.0, 20.0};
  limits.cvs.resize(2);
  const std::vector<PlannedTest> plan = test_plan(found, limits, 3);
  REQUIRE(!plan.empty());
  const auto test = std::find_if(plan.begin(), plan.end(),
                                 [](const PlannedTest& each) { return each.input == 1; });
  REQUIRE(test != plan.end());
  CHECK(test->cvs == std::vector<int>{0, 1});
  CHECK(test->amplitude == Approx(1.0));  // a tenth of 20, half of it to either side
  // At least the 5 time constants of 30 s of CV 0's slowest channel.
  CHECK(test->settling_s > 100.0);
  CHECK(test->duration_s >= 4.0 * test->settling_s);
}

TEST_CASE(
    "an input that moved little beside its limits is planned a test though nothing was seen") {
  // Input 1 does nothing to CV 0. That is known well enough for moves of its size, not for moves of
  // hundred times that.
  const Identification found = identify(open_loop(2000, 840), {});
  REQUIRE(answer_of(found, 0, 1).left_out == LeftOut::kNoRelation);
  TestLimits limits;
  limits.inputs.resize(3);
  limits.cvs.resize(2);
  const auto planned = [&](double high) {
    limits.inputs[1] = {0.0, high};
    const std::vector<PlannedTest> plan = test_plan(found, limits, 3);
    return std::any_of(plan.begin(), plan.end(), [](const PlannedTest& each) {
      return each.input == 1 && each.cvs == std::vector<int>{0};
    });
  };
  CHECK_FALSE(planned(20.0));
  CHECK(planned(2000.0));
}

}  // namespace mpm::test
