#include <catch2/catch.hpp>
#include <numeric>
#include <string>
#include <utility>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"
#include "core/identify/diagnosis/setpoint_rival.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::feedback_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
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
TEST_CASE("a sound loop at rest accuses nothing, whatever disturbs it", "[trials]") {
  const VectorXd still = VectorXd::Zero(kRows);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    CHECK(accusations(Loop(1.0, walk(seed), still).diagnosed()).empty());
    CHECK(accusations(Loop(1.0, cycle(seed), still).diagnosed()).empty());
    CHECK(accusations(Loop(1.0, steps(10 * seed), still).diagnosed()).empty());
  }
}

// The two together remember far longer than either: what a noise model with a short past forgets of
// them, the controller has made to go with the input. With eight coefficients 17 of the 20
// intervals miss the sound gain, which is 2 to 3 times too large for them.
TEST_CASE(
    "the gain of a loop whose CV wanders and is measured with noise is known as well as it is",
    "[trials]") {
  struct Case {
    double walk, noise, moves;
    Index hold;
  };
  int misses = 0;
  for (const Case& each :
       {Case{0.3, 0.2, 0.3, 300}, Case{0.3, 0.4, 0.3, 300}, Case{0.5, 0.5, 0.5, 150},
        Case{0.2, 0.4, 0.5, 100}, Case{0.3, 0.3, 0.0, 100}})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      CAPTURE(each.walk, each.noise, seed);
      const VectorXd disturbance =
          each.walk * walk(seed) + each.noise * test::normal(seed + 50, kRows);
      const Diagnosis diagnosis = Loop(1.0, disturbance, VectorXd::Zero(kRows),
                                       each.moves * test::telegraph(seed + 90, kRows, each.hold))
                                      .diagnosed();
      CHECK(diagnosis.findings.empty());
      const Parameter& gain = diagnosis.channels.at(0).gain_ratio;
      misses += gain.low <= 1.0 && 1.0 <= gain.high ? 0 : 1;
    }
  // More than four of 20 would come in 1 of 400 versions were they 95 % intervals.
  CHECK(misses <= 4);
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

Loop wrong_gain(std::uint64_t seed, double size, Index hold) {
  const VectorXd disturbance = test::autoregressive(0.08 * test::normal(seed + 30, kRows), 0.97) +
                               0.03 * test::normal(seed + 40, kRows);
  return {1.5, disturbance, VectorXd::Zero(kRows), size * test::telegraph(seed, kRows, hold)};
}

// u is what the set-point and the CV make it, so a set-point and another noise can say all that the
// gain does, and say it better to a noise model that does not wander enough.
TEST_CASE("a wrong gain under feedback is the channel's, not the set-point's") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    const Diagnosis diagnosis = wrong_gain(seed, 3.0, 60).diagnosed();
    CAPTURE(diagnosis.reason);
    REQUIRE(diagnosis.findings.size() == 1);
    const Finding& finding = diagnosis.findings.front();
    // Of one channel alone these three are the same.
    CHECK((finding.subject.cause == &causes::gain() ||
           finding.subject.cause == &causes::input_scale() ||
           finding.subject.cause == &causes::output_scale()));
    CHECK(finding.parameters[0].value == Approx(1.5).margin(0.1));
    // In the first two loops the test of the channels does not tell them apart, in the third it
    // does.
    const bool told_apart = seed == 3;
    CHECK((finding.rivals.at(0).subject.place.aux != 0) == told_apart);
    CHECK((finding.confidence > 10.0 / 11.0) == told_apart);
  }
}

TEST_CASE("undecided, what leaves the channels' test something to see is not laid to a channel") {
  const Diagnosis diagnosis = wrong_gain(6, 2.0, 120).diagnosed();
  CHECK(accusations(diagnosis).empty());
  REQUIRE_FALSE(diagnosis.refused.empty());
  CHECK(diagnosis.refused.front().refused == kOwnSetpoint);
}

// Two such loops, each CV with an input of its own and a lag of gain 0.6, time constant 20, to the
// other's.
struct TwoLoops {
  std::uint64_t seed = 1;
  double across_ratio = 1.0;  ///< hidden: of the gain from the second input to the first CV
  Index stuck_from = kRows;   ///< hidden: the first input's actuator rests from here on
  double follows = 0.0;       ///< hidden: the second CV has so much of its own set-point, lagged

  [[nodiscard]] Diagnosis diagnosed() const {
    constexpr double kAcross = 0.6;
    MatrixXd u = MatrixXd::Zero(kRows, 2), y = u, setpoints(kRows, 2), noise(kRows, 2);
    setpoints << 3.0 * test::telegraph(seed, kRows, 100),
        2.0 * test::telegraph(seed + 1, kRows, 140);
    noise << test::autoregressive(0.08 * test::normal(seed + 2, kRows), 0.95),
        test::autoregressive(0.08 * test::normal(seed + 3, kRows), 0.95) +
            follows * test::first_order(setpoints.col(1), 1.0, 12.0);
    const double own = std::exp(-0.1), other = std::exp(-0.05);
    Vector2d main = Vector2d::Zero(), cross = main, sum = main, moved = main;
    for (Index k = 0; k < kRows; ++k) {
      y.row(k) = (main + cross).transpose() + noise.row(k);
      const Vector2d error = (setpoints.row(k) - y.row(k)).transpose();
      sum += error;
      const double rests = moved(0);
      moved = 0.4 * error + 0.04 * sum;
      u.row(k) = moved.transpose();
      if (k >= stuck_from) moved(0) = rests;
      main = own * main + 2.0 * (1.0 - own) * moved;
      cross = other * cross + kAcross * (1.0 - other) * Vector2d(across_ratio * moved(1), moved(0));
    }
    Recording recording = test::recording_of(u, y);
    recording.setpoints = setpoints;
    DiagnosisSettings settings;
    settings.mv_count = 2;
    return diagnose(test::model_of({lag(0, 0, 2.0, 10.0), lag(0, 1, kAcross, 20.0),
                                    lag(1, 0, kAcross, 20.0), lag(1, 1, 2.0, 10.0)},
                                   2, 2),
                    recording, nullptr, settings);
  }
};

TEST_CASE("another CV's set-point is not named where the channels' test explains more") {
  for (const std::uint64_t seed : {121, 131, 141}) {
    CAPTURE(seed);
    const Diagnosis diagnosis = TwoLoops{.seed = seed, .across_ratio = 1.5}.diagnosed();
    CHECK(diagnosis.verdict == DiagnosisVerdict::kUndetermined);
    CHECK(diagnosis.findings.empty());
    REQUIRE(diagnosis.refused.size() == 1);
    CHECK(diagnosis.refused[0].subject == Subject{&causes::unmodelled_input(), {0, -1, 1}});
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

// Before the actuator is repaired nobody sees it: its CVs are off by far more.
TEST_CASE("what follows a set-point beside a stuck actuator is laid to no channel", "[trials]") {
  for (const std::uint64_t seed : {71, 81}) {
    CAPTURE(seed);
    const Diagnosis diagnosis =
        TwoLoops{.seed = seed, .stuck_from = 700, .follows = 0.3}.diagnosed();
    REQUIRE(diagnosis.findings.size() == 1);
    CHECK(diagnosis.findings[0].subject == Subject{&causes::input_stuck(), {-1, 0}});
    REQUIRE_FALSE(diagnosis.refused.empty());
    CHECK(diagnosis.refused[0].subject.place.cv == 1);
  }
}

}  // namespace
}  // namespace mpm::feedback_test
