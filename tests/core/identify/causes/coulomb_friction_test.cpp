#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"
#include "tests/core/identify/causes/servo.hpp"

namespace mpm::test::coulomb_friction_test {
namespace {

constexpr Eigen::Index kRows = 2500;

/// A mass on a spring, ringing every 100 s, and one that nothing pulls back.
Servo on_spring(double friction) { return {270.0, 9.0, 1.0, friction}; }
Servo free_mass(double friction) { return {15.0, 1.0, 0.0, friction}; }

/// A position under a command of random levels, by a model that knows no friction.
Diagnosis diagnosed(const Servo& servo, std::uint64_t seed) {
  const bool spring = servo.spring > 0.0;
  const Eigen::Index hold = spring ? 150 : 40;
  const Eigen::VectorXd command = Eigen::VectorXd::NullaryExpr(
      kRows, [&](Eigen::Index k) { return k < 20 ? 0.0 : uniform(seed, k / hold); });
  const Eigen::VectorXd measured =
      servo.respond(command) + (spring ? 0.01 : 0.1) * normal(100 + seed, kRows);
  return diagnose(model_of({servo.model()}, 1, 1), recording_of(command, measured), nullptr, {});
}

/// The force of the friction that was named first, which must be all there is to say.
Parameter named_force(const Diagnosis& diagnosis) {
  REQUIRE(diagnosis.verdict == DiagnosisVerdict::kMismatch);
  REQUIRE_FALSE(diagnosis.findings.empty());
  const Finding& first = diagnosis.findings.front();
  CHECK(first.subject.cause == &causes::coulomb_friction());
  CHECK(first.subject.place == Place{0, 0});
  CHECK(diagnosis.scores[0].rmse_after < 0.3 * diagnosis.scores[0].rmse_before);
  REQUIRE_FALSE(first.parameters.empty());
  CHECK(first.parameters.front().name() == "force");
  return first.parameters.front();
}

/// Commands go from -1 to 1, so this is a twentieth of what they move.
constexpr double kFriction = 0.1;

}  // namespace

// The truth is the friction of the servo, which no simulator of ours moved.
TEST_CASE("Dry friction on a spring is named, and its force is right within its interval",
          "[trials]") {
  int covered = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    CAPTURE(seed);
    const Parameter force = named_force(diagnosed(on_spring(kFriction), seed));
    CHECK(force.value == Approx(kFriction).epsilon(0.03));
    covered += force.low <= kFriction && kFriction <= force.high ? 1 : 0;
  }
  CHECK(covered >= 5);  // of 95 % intervals: by chance fewer in 3 %
}

// Friction acts by the motion of the last sample, so what nothing pulls back gets a force that is
// one or two per cent too large, which the interval does not count.
TEST_CASE("Dry friction without a spring is named, and its force is nearly right") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    CHECK(named_force(diagnosed(free_mass(kFriction), seed)).value ==
          Approx(kFriction).epsilon(0.05));
  }
}

TEST_CASE("Where there is no friction none is named") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    CHECK(diagnosed(on_spring(0.0), seed).findings.empty());
    CHECK(diagnosed(free_mass(0.0), seed).findings.empty());
  }
}

// Without inertia dry friction F is play of 2 F: the position follows the command's turns late.
TEST_CASE("On a channel without inertia it goes by the name of play") {
  const Servo slow{48.0, 16.0, 1.0, kFriction};  // 12 s and 4 s
  const Eigen::VectorXd command = Eigen::VectorXd::NullaryExpr(
      kRows, [](Eigen::Index k) { return k < 20 ? 0.0 : uniform(1, k / 40); });
  const Eigen::VectorXd measured = slow.respond(command) + 0.01 * normal(101, kRows);
  const ChannelSpec lags{0, 0, TransferFunction{1.0, {12.0, 4.0}, 0.0, 0.0, false}, {}};
  const Diagnosis diagnosis =
      diagnose(model_of({lags}, 1, 1), recording_of(command, measured), nullptr, {});
  REQUIRE_FALSE(diagnosis.findings.empty());
  const Finding& first = diagnosis.findings.front();
  CHECK(first.subject.cause == &causes::deadband());
  REQUIRE_FALSE(first.parameters.empty());
  CHECK(first.parameters.front().value == Approx(2.0 * kFriction).epsilon(0.1));
}

}  // namespace mpm::test::coulomb_friction_test
