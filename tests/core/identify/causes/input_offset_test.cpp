#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

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

// The valve lets through too much of what the plant answers in a curve, whichever is found first.
TEST_CASE("a leak is named beside a curve of the same input") {
  for (std::uint64_t seed = 71; seed <= 73; ++seed) {
    CAPTURE(seed);
    MatrixXd inputs = commands(seed);
    inputs.col(0) += 0.6 * telegraph(seed + 100, kActuatorRows, 40);
    const VectorXd acts = offset(inputs.col(0), kActuatorOnset);
    const VectorXd bent = acts.array() + 0.3 * acts.array().square();
    const Diagnosis diagnosis = diagnosed(inputs, bent, 200 + seed);
    const auto found = [&](const Cause& cause) {
      return std::find_if(diagnosis.findings.begin(), diagnosis.findings.end(),
                          [&](const Finding& finding) {
                            return finding.subject == Subject{&cause, {-1, 0}};
                          });
    };
    const auto leak = found(causes::input_offset());
    REQUIRE(leak != diagnosis.findings.end());
    CHECK(leak->parameters.front().value == Approx(0.5).margin(0.06));
    CHECK(leak->repaired);
    const auto curve = found(causes::input_polynomial());
    REQUIRE(curve != diagnosis.findings.end());
    CHECK(curve->repaired);
    CHECK(diagnosis.findings.size() == 2);
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

// Not a leak but what the actuator feeds, if a signal saw it change; a set-point saw nothing.
TEST_CASE("an offset may be said as a signal that moved at the same moment") {
  const MatrixXd inputs = commands(31);
  Recording recording = recording_of(
      inputs, respond(offset(inputs.col(0), kActuatorOnset), inputs.col(1)) + noise(131, 2));
  Effect leak{&causes::input_offset(), {-1, 0}, {}};
  leak.onset = kActuatorOnset;
  const auto rewrites = [&] {
    const Problem problem(with_aux_inputs(both(), recording), 2, recording, Tolerances{},
                          NoiseModel{});
    return causes::input_offset().rewrites(0, {leak}, problem, Tolerances{});
  };
  recording.aux = noise(231, 2);
  CHECK(rewrites().empty());
  recording.aux.col(1).tail(kActuatorRows - kActuatorOnset).array() += 5.0;
  recording.aux(0, 1) = std::nan("");
  const std::vector<Rewrite> found = rewrites();
  REQUIRE(found.size() == 1);
  CHECK(found[0].without == std::vector<std::size_t>{0});
  REQUIRE_FALSE(found[0].with.empty());
  for (const Effect& effect : found[0].with) {
    CHECK(effect.edit == &causes::unmodelled_input());
    CHECK(effect.place.aux == 1);
  }
  recording.setpoints = recording.aux.col(1);
  CHECK(rewrites().empty());
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
