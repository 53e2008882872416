#pragma once

#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"
#include "tests/core/identify/proposals.hpp"
#include "tests/core/identify/small_plant.hpp"

/// Plants in closed form of which the first actuator does not do as it is told.
namespace mpm::test {

inline constexpr Eigen::Index kActuatorRows = 1200;
inline constexpr Eigen::Index kActuatorOnset = 300;
inline constexpr double kActuatorNoise = 0.1;

/// Two inputs and two CVs, each of which answers both.
inline ModelSpec both() {
  return model_of({lag(0, 0, 2.0, 10.0, 2.0), lag(0, 1, -1.0, 5.0, 1.0), lag(1, 0, 1.0, 20.0, 4.0),
                   lag(1, 1, 1.5, 8.0)},
                  2, 2);
}
inline Eigen::MatrixXd respond(const Eigen::VectorXd& u1, const Eigen::VectorXd& u2) {
  Eigen::MatrixXd cvs(u1.size(), 2);
  cvs << first_order(u1, 2.0, 10.0, 2) - first_order(u2, 1.0, 5.0, 1),
      first_order(u1, 1.0, 20.0, 4) + first_order(u2, 1.5, 8.0);
  return cvs;
}

inline Eigen::MatrixXd noise(std::uint64_t seed, Eigen::Index cvs) {
  Eigen::MatrixXd values(kActuatorRows, cvs);
  for (Eigen::Index cv = 0; cv < cvs; ++cv)
    values.col(cv) =
        kActuatorNoise *
        autoregressive(normal(seed + static_cast<std::uint64_t>(cv), kActuatorRows), 0.5);
  return values;
}

inline Eigen::MatrixXd commands(std::uint64_t seed) {
  Eigen::MatrixXd inputs(kActuatorRows, 2);
  inputs << telegraph(seed, kActuatorRows, 25), telegraph(seed + 1, kActuatorRows, 18);
  return inputs;
}

/// What the first input does where it is stuck at 0.4 from a row on, or 0.5 more than commanded.
inline Eigen::VectorXd stuck(Eigen::VectorXd u, Eigen::Index from) {
  u.tail(u.size() - from).setConstant(0.4);
  return u;
}
inline Eigen::VectorXd offset(Eigen::VectorXd u, Eigen::Index from) {
  u.tail(u.size() - from).array() += 0.5;
  return u;
}

inline Diagnosis diagnosed(const Eigen::MatrixXd& inputs, const Eigen::VectorXd& first_acts,
                           std::uint64_t seed) {
  const Eigen::MatrixXd cvs = respond(first_acts, inputs.col(1)) + noise(seed, 2);
  return diagnose(both(), recording_of(inputs, cvs), nullptr, {.mv_count = 2});
}

inline Parameter first_number(const Diagnosis& diagnosis, const Cause& cause) {
  REQUIRE(diagnosis.verdict == DiagnosisVerdict::kMismatch);
  REQUIRE_FALSE(diagnosis.findings.empty());
  const Finding& first = diagnosis.findings.front();
  CHECK(first.subject.cause == &cause);
  CHECK(first.subject.place == Place{-1, 0});
  REQUIRE_FALSE(first.parameters.empty());
  return first.parameters.front();
}

}  // namespace mpm::test
