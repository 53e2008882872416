#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/causes/actuator_bench.hpp"

namespace mpm::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST_CASE("an actuator that sticks is named, with where and since when") {
  for (std::uint64_t seed = 11; seed <= 13; ++seed) {
    CAPTURE(seed);
    const MatrixXd inputs = commands(seed);
    const Diagnosis diagnosis = diagnosed(inputs, stuck(inputs.col(0), kActuatorOnset), 100 + seed);
    const Parameter value = first_number(diagnosis, causes::input_stuck());
    CHECK(value.name() == "value");
    CHECK(value.value == Approx(0.4).margin(0.1));
    CHECK(diagnosis.findings.size() == 1);
    REQUIRE(diagnosis.findings.front().onset_s);
    // From one command's move to the next nothing tells.
    CHECK(*diagnosis.findings.front().onset_s == Approx(double{kActuatorOnset}).margin(25.0));
    for (const CvScore& score : diagnosis.scores) CHECK(score.rmse_after < 0.3 * score.rmse_before);
  }
}

TEST_CASE("an actuator that never moved is named") {
  const MatrixXd inputs = commands(21);
  const Diagnosis diagnosis = diagnosed(inputs, VectorXd::Constant(kActuatorRows, 0.4), 121);
  (void)first_number(diagnosis, causes::input_stuck());
  CHECK_FALSE(diagnosis.findings.front().onset_s);
}

}  // namespace
}  // namespace mpm::test
