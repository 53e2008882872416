// Actuators that stick or leak, in plants in closed form.
#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"
#include "tests/core/identify/proposals.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kRows = 1200;
constexpr Index kOnset = 300;
constexpr double kNoise = 0.1;

/// Two inputs and two CVs, each of which answers both.
ModelSpec both() {
  return model_of({lag(0, 0, 2.0, 10.0, 2.0), lag(0, 1, -1.0, 5.0, 1.0), lag(1, 0, 1.0, 20.0, 4.0),
                   lag(1, 1, 1.5, 8.0)},
                  2, 2);
}
MatrixXd respond(const VectorXd& u1, const VectorXd& u2) {
  MatrixXd cvs(u1.size(), 2);
  cvs << first_order(u1, 2.0, 10.0, 2) - first_order(u2, 1.0, 5.0, 1),
      first_order(u1, 1.0, 20.0, 4) + first_order(u2, 1.5, 8.0);
  return cvs;
}

MatrixXd noise(std::uint64_t seed, Index cvs) {
  MatrixXd values(kRows, cvs);
  for (Index cv = 0; cv < cvs; ++cv)
    values.col(cv) =
        kNoise * autoregressive(normal(seed + static_cast<std::uint64_t>(cv), kRows), 0.5);
  return values;
}

MatrixXd commands(std::uint64_t seed) {
  MatrixXd inputs(kRows, 2);
  inputs << telegraph(seed, kRows, 25), telegraph(seed + 1, kRows, 18);
  return inputs;
}

/// What the first input does where it is stuck at 0.4 from a row on, or 0.5 more than commanded.
VectorXd stuck(VectorXd u, Index from) {
  u.tail(u.size() - from).setConstant(0.4);
  return u;
}
VectorXd offset(VectorXd u, Index from) {
  u.tail(u.size() - from).array() += 0.5;
  return u;
}

Diagnosis diagnosed(const MatrixXd& inputs, const VectorXd& first_acts, std::uint64_t seed) {
  const MatrixXd cvs = respond(first_acts, inputs.col(1)) + noise(seed, 2);
  return diagnose(both(), recording_of(inputs, cvs), nullptr, {.mv_count = 2});
}

Parameter first_number(const Diagnosis& diagnosis, const Cause& cause) {
  REQUIRE(diagnosis.verdict == DiagnosisVerdict::kMismatch);
  REQUIRE_FALSE(diagnosis.findings.empty());
  const Finding& first = diagnosis.findings.front();
  CHECK(first.subject.cause == &cause);
  CHECK(first.subject.place == Place{-1, 0});
  REQUIRE_FALSE(first.parameters.empty());
  return first.parameters.front();
}

}  // namespace

TEST_CASE("an actuator that sticks is named, with where and since when") {
  for (std::uint64_t seed = 11; seed <= 13; ++seed) {
    CAPTURE(seed);
    const MatrixXd inputs = commands(seed);
    const Diagnosis diagnosis = diagnosed(inputs, stuck(inputs.col(0), kOnset), 100 + seed);
    const Parameter value = first_number(diagnosis, causes::input_stuck());
    CHECK(value.name() == "value");
    CHECK(value.value == Approx(0.4).margin(0.1));
    CHECK(diagnosis.findings.size() == 1);
    REQUIRE(diagnosis.findings.front().onset_s);
    // From one command's move to the next nothing tells.
    CHECK(*diagnosis.findings.front().onset_s == Approx(double{kOnset}).margin(25.0));
    for (const CvScore& score : diagnosis.scores) CHECK(score.rmse_after < 0.3 * score.rmse_before);
  }
}

TEST_CASE("an actuator that never moved is named") {
  const MatrixXd inputs = commands(21);
  const Diagnosis diagnosis = diagnosed(inputs, VectorXd::Constant(kRows, 0.4), 121);
  (void)first_number(diagnosis, causes::input_stuck());
  CHECK_FALSE(diagnosis.findings.front().onset_s);
}

TEST_CASE("an actuator that begins to leak is named, with how much and since when") {
  for (std::uint64_t seed = 31; seed <= 33; ++seed) {
    CAPTURE(seed);
    const MatrixXd inputs = commands(seed);
    const Diagnosis diagnosis = diagnosed(inputs, offset(inputs.col(0), kOnset), 100 + seed);
    const Parameter size = first_number(diagnosis, causes::input_offset());
    CHECK(size.name() == "size");
    CHECK(size.value == Approx(0.5).margin(0.06));
    CHECK(diagnosis.findings.size() == 1);
    REQUIRE(diagnosis.findings.front().onset_s);
    CHECK(*diagnosis.findings.front().onset_s == Approx(double{kOnset}).margin(3.0));
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
    cvs.col(0).tail(kRows - kOnset) += VectorXd::Constant(kRows - kOnset, 1.0);
    const Diagnosis diagnosis =
        diagnose(both(), recording_of(inputs, cvs), nullptr, {.mv_count = 2});
    REQUIRE_FALSE(diagnosis.findings.empty());
    CHECK(diagnosis.findings.front().subject.cause == &causes::step_disturbance());
  }
}

// With one CV the two say the same, and disturbances are the more usual: no actuator is accused.
TEST_CASE("with one CV a leak is told as a disturbance that comes in alike") {
  const VectorXd u = telegraph(71, kRows, 25);
  const MatrixXd cv = first_order(offset(u, kOnset), 2.0, 10.0, 2) + noise(171, 1).col(0);
  const Diagnosis diagnosis = diagnose(model_of({lag(0, 0, 2.0, 10.0, 2.0)}, 1, 1),
                                       recording_of(u, cv), nullptr, {.mv_count = 1});
  REQUIRE_FALSE(diagnosis.findings.empty());
  CHECK(diagnosis.findings.front().subject.cause == &causes::step_disturbance());
  for (const Finding& finding : diagnosis.findings)
    CHECK(finding.subject.cause != &causes::input_offset());
}

}  // namespace mpm::test
