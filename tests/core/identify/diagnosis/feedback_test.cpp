#include <catch2/catch.hpp>
#include <numeric>
#include <string>
#include <utility>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::lag;

// Loops in closed form: y(k+1) = p y(k) + ratio * 2 (1 - p) u(k), a disturbance on the output, and
// a PI controller at a set-point that stands still where none is given. The model says gain 2, time
// constant 10.
constexpr Index kRows = 1800;

struct Loop {
  VectorXd u = VectorXd::Zero(kRows), y = VectorXd::Zero(kRows), setpoint;

  Loop(double ratio, const VectorXd& disturbance, const VectorXd& shaken,
       VectorXd followed = VectorXd::Zero(kRows))
      : setpoint(std::move(followed)) {
    const double pole = std::exp(-0.1);
    double state = 0.0, sum = 0.0;
    for (Index k = 0; k < kRows; ++k) {
      y(k) = state + disturbance(k);
      const double error = setpoint(k) - y(k);
      sum += error;
      u(k) = 0.6 * error + 0.06 * sum + shaken(k);
      state = pole * state + ratio * 2.0 * (1.0 - pole) * u(k);
    }
  }

  [[nodiscard]] Diagnosis diagnosed() const {
    DiagnosisSettings settings;
    settings.mv_count = 1;
    Recording recording = test::recording_of(u, y);
    recording.setpoints = setpoint;
    return diagnose(test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1), recording, nullptr, settings);
  }
};

VectorXd walk(std::uint64_t seed) {
  return test::autoregressive(0.1 * test::normal(seed, kRows), 1.0);
}

VectorXd cycle(std::uint64_t seed) {
  return VectorXd::NullaryExpr(
             kRows, [](Index k) { return std::sin(2.0 * M_PI * static_cast<double>(k) / 250.0); }) +
         0.05 * test::normal(seed, kRows);
}

VectorXd steps(std::uint64_t seed) {
  return test::telegraph(seed, kRows, 300) + 0.05 * test::normal(seed + 1, kRows);
}

/// Everything that accuses the channel, its valve or its sensor.
std::string accusations(const Diagnosis& diagnosis) {
  std::string all;
  for (const Finding& finding : diagnosis.findings)
    if (finding.subject.cause->acts_through_channels() || finding.subject.cause->is_input_block())
      all += std::string(finding.subject.cause->name().text) + " ";
  return all;
}

// A free run is best without any gain here: the controller undoes what disturbs the CV.
TEST_CASE("a sound loop at rest accuses nothing, whatever disturbs it") {
  const VectorXd still = VectorXd::Zero(kRows);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    CHECK(accusations(Loop(1.0, walk(seed), still).diagnosed()).empty());
    CHECK(accusations(Loop(1.0, cycle(seed), still).diagnosed()).empty());
    CHECK(accusations(Loop(1.0, steps(10 * seed), still).diagnosed()).empty());
  }
}

// Its sensor's span would leave the same.
TEST_CASE("what follows the CV's own set-point is told, and not named") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    const VectorXd setpoint = test::telegraph(seed, kRows, 60);
    const VectorXd moved = test::first_order(setpoint, 0.3, 12.0);
    const Diagnosis diagnosis =
        Loop(1.0, moved + 0.05 * test::normal(seed + 5, kRows), VectorXd::Zero(kRows), setpoint)
            .diagnosed();
    CHECK(accusations(diagnosis).empty());
    for (const Finding& finding : diagnosis.findings)
      CHECK(finding.subject.cause != &causes::unmodelled_input());
    CHECK(diagnosis.verdict != DiagnosisVerdict::kMatch);
    CHECK((diagnosis.reason.find("own set-point") != std::string::npos ||
           !diagnosis.findings.empty()));
  }
}

// u is what the set-point and the CV make it, so a set-point and another noise can say all that the
// gain does, and say it better to a noise model that does not wander enough.
TEST_CASE("a wrong gain under feedback is the channel's, not the set-point's") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    const VectorXd disturbance = test::autoregressive(0.08 * test::normal(seed + 30, kRows), 0.97) +
                                 0.03 * test::normal(seed + 40, kRows);
    const Diagnosis diagnosis =
        Loop(1.5, disturbance, VectorXd::Zero(kRows), 3.0 * test::telegraph(seed, kRows, 60))
            .diagnosed();
    CAPTURE(diagnosis.reason);
    REQUIRE(diagnosis.findings.size() == 1);
    const Finding& finding = diagnosis.findings.front();
    // Of one channel alone these three are the same.
    CHECK((finding.subject.cause == &causes::gain() ||
           finding.subject.cause == &causes::input_scale() ||
           finding.subject.cause == &causes::output_scale()));
    CHECK(finding.parameters[0].value == Approx(1.5).margin(0.1));
    // What nobody can tell apart is told: a set-point is ten times less likely.
    for (const Rival& rival : finding.rivals)
      if (rival.subject.place.aux == 0) CHECK(finding.confidence <= 10.0 / 11.0);
  }
}

TEST_CASE("test signals make a wrong gain known in the same loops") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    const Diagnosis diagnosis =
        Loop(1.6, walk(seed), 2.0 * test::telegraph(seed + 20, kRows, 15)).diagnosed();
    REQUIRE_FALSE(diagnosis.findings.empty());
    bool found = false;
    for (const Finding& finding : diagnosis.findings) {
      if (!finding.subject.cause->acts_through_channels()) continue;
      CHECK((finding.subject.cause == &causes::gain() ||
             finding.subject.cause == &causes::input_scale() ||
             finding.subject.cause == &causes::output_scale()));
      CHECK(finding.parameters[0].value == Approx(1.6).margin(0.15));
      found = true;
    }
    CHECK(found);
  }
}

}  // namespace
}  // namespace mpm
