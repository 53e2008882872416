#include <algorithm>
#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/causes/actuator_bench.hpp"

namespace mpm::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST_CASE("an actuator that begins to leak is named, with how much and since when") {
  for (std::uint64_t seed = 31; seed <= 33; ++seed) {
    CAPTURE(seed);
    const MatrixXd inputs = commands(seed);
    const Diagnosis diagnosis =
        diagnosed(inputs, offset(inputs.col(0), kActuatorOnset), 100 + seed);
    const Parameter size = first_number(diagnosis, causes::input_offset());
    CHECK(size.name() == "size");
    CHECK(size.value == Approx(0.5).margin(0.06));
    CHECK(diagnosis.findings.size() == 1);
    REQUIRE(diagnosis.findings.front().onset_s);
    CHECK(*diagnosis.findings.front().onset_s == Approx(double{kActuatorOnset}).margin(3.0));
  }
}

TEST_CASE("a leak that was always there is no more than a level") {
  const MatrixXd inputs = commands(41);
  for (const Finding& finding : diagnosed(inputs, offset(inputs.col(0), 0), 141).findings)
    CHECK(finding.subject.cause != &causes::input_offset());
}

TEST_CASE("where the actuators do as they are told neither is named") {
  for (std::uint64_t seed = 51; seed <= 54; ++seed) {
    CAPTURE(seed);
    const MatrixXd inputs = commands(seed);
    CHECK(diagnosed(inputs, inputs.col(0), 100 + seed).findings.empty());
  }
}

// One CV moves up through a lag of its own: no actuator moves both.
TEST_CASE("a step in one of several CVs is no leak") {
  for (std::uint64_t seed = 61; seed <= 63; ++seed) {
    CAPTURE(seed);
    const MatrixXd inputs = commands(seed);
    MatrixXd cvs = respond(inputs.col(0), inputs.col(1)) + noise(100 + seed, 2);
    cvs.col(0).tail(kActuatorRows - kActuatorOnset) +=
        VectorXd::Constant(kActuatorRows - kActuatorOnset, 1.0);
    const Diagnosis diagnosis =
        diagnose(both(), recording_of(inputs, cvs), nullptr, {.mv_count = 2});
    REQUIRE_FALSE(diagnosis.findings.empty());
    CHECK(diagnosis.findings.front().subject.cause == &causes::step_disturbance());
  }
}

// With one CV the two say the same, and disturbances are the more usual: no actuator is accused.
TEST_CASE("with one CV a leak is told as a disturbance that comes in alike") {
  const VectorXd u = telegraph(71, kActuatorRows, 25);
  const MatrixXd cv = first_order(offset(u, kActuatorOnset), 2.0, 10.0, 2) + noise(171, 1).col(0);
  const Diagnosis diagnosis = diagnose(model_of({lag(0, 0, 2.0, 10.0, 2.0)}, 1, 1),
                                       recording_of(u, cv), nullptr, {.mv_count = 1});
  REQUIRE_FALSE(diagnosis.findings.empty());
  CHECK(diagnosis.findings.front().subject.cause == &causes::step_disturbance());
  for (const Finding& finding : diagnosis.findings)
    CHECK(finding.subject.cause != &causes::input_offset());
}

}  // namespace
}  // namespace mpm::test
