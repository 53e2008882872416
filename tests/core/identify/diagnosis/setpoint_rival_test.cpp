#include "core/identify/diagnosis/setpoint_rival.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::setpoint_rival_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 1500;
constexpr int kOften = 20;
constexpr int kFirst = 0;  // no aux signals: the first behind them is the first CV's set-point

/// Two CVs with an input each. What the set-points do comes on top of the CVs; the first input
/// moves partly with its CV's set-point, so that the test sees something wrong there.
struct Bench {
  ChannelTests tests;

  /// `ratio`: of the first channel's gain; `own`: of the first set-point's effect on its CV.
  Bench(double ratio, double own) : tests(make(ratio, own)) {}

  static ChannelTests make(double ratio, double own) {
    MatrixXd u(kRows, 2), setpoints(kRows, 2), residuals(kRows, 2);
    setpoints << test::telegraph(5, kRows, 40), test::telegraph(6, kRows, 50);
    u << test::telegraph(1, kRows, 12) + 0.5 * setpoints.col(0), test::telegraph(2, kRows, 9);
    residuals << (ratio - 1.0) * test::first_order(u.col(0), 2.0, 10.0) +
                     own * test::first_order(setpoints.col(0), 1.0, 30.0) +
                     0.1 * test::white(3, kRows),
        0.1 * test::white(4, kRows);
    Recording recording = test::recording_of(u, residuals);
    recording.setpoints = setpoints;
    return {test::model_of({lag(0, 0, 2.0, 10.0), lag(1, 1, 1.0, 5.0)}, 2, 2), recording,
            residuals};
  }
};

Effect of(const Cause& cause, const Place& place) {
  Effect effect;
  effect.edit = &cause;
  effect.place = place;
  return effect;
}

Effect setpoint(int cv, int aux) { return of(causes::unmodelled_input(), {cv, -1, aux}); }

Named strongly(int cv, int aux) {
  Named named;
  named.effect = setpoint(cv, aux);
  named.evidence = 40.0;
  return named;
}

TEST_CASE("whether a CV's own set-point may be named the test of its channels says") {
  const Bench wrong(1.5, 0.0), hidden(1.0, 1.0);
  CHECK_FALSE(may_name_setpoint(setpoint(0, 0), wrong.tests, kFirst));
  CHECK(may_name_setpoint(setpoint(0, 0), hidden.tests, kFirst));
  CHECK(may_name_setpoint(setpoint(0, 1), wrong.tests, kFirst));  // another's
  CHECK(may_name_setpoint(setpoint(1, 1), wrong.tests, kFirst));  // nothing is wrong there
}

TEST_CASE("what a set-point is said to do is refused where it loses alone, or is the CV's own") {
  const Bench wrong(1.5, 0.0), hidden(1.0, 1.0);
  const char* own = why_not_setpoint(strongly(0, 0), false, kOften, hidden.tests, kFirst);
  REQUIRE(own != nullptr);
  CHECK(std::string(own) == kOwnSetpoint);
  CHECK(why_not_setpoint(strongly(0, 1), true, kOften, wrong.tests, kFirst) != nullptr);
  CHECK(why_not_setpoint(strongly(0, 1), false, kOften, wrong.tests, kFirst) == nullptr);
  CHECK(why_not_setpoint(strongly(0, 1), true, kOften, hidden.tests, kFirst) == nullptr);
  CHECK(why_not_setpoint(strongly(1, 0), true, kOften, wrong.tests, kFirst) == nullptr);
  Named weakly = strongly(1, 0);
  weakly.evidence = 25.0;
  CHECK(why_not_setpoint(weakly, true, kOften, wrong.tests, kFirst) != nullptr);
}

// Up, rest, a ramp down, up again behind it without a rest, rest, and on up: four.
TEST_CASE("a set-point that moves a few times explains nothing for sure") {
  VectorXd signal(10);
  signal << 0, 1, 1, 0.5, 0, 2, 2, 3, 3, 3;
  CHECK(moves(signal) == 4);
  CHECK(moves(VectorXd::Ones(10)) == 0);
  const Bench hidden(1.0, 1.0);
  const char* seldom = why_not_setpoint(strongly(1, 0), true, 4, hidden.tests, kFirst);
  REQUIRE(seldom != nullptr);
  CHECK(std::string(seldom).find("too seldom") != std::string::npos);
}

// The channel has no dead time and a lag of 10 rows: what comes within 11 rows of the set-point's
// step may be its doing.
TEST_CASE("a step that comes with its own set-point's, and the same way, is no disturbance") {
  constexpr Index kStep = 100;
  const ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  Recording signals = test::recording_of(VectorXd::Zero(200), VectorXd::Zero(200));
  const auto doubted = [&](double size, Index onset) {
    Effect effect = of(causes::step_disturbance(), {0});
    effect.onset = onset;
    effect.coordinates = {{.value = size}};
    return why_not_step(effect, {Named{effect, 0.0, 0.0, {}}}, model, signals) != nullptr;
  };
  CHECK_FALSE(doubted(2.0, kStep + 5));  // no set-point
  signals.setpoints = MatrixXd::Zero(200, 1);
  CHECK_FALSE(doubted(2.0, kStep + 5));  // it stands still
  signals.setpoints.bottomRows(200 - kStep).setOnes();
  CHECK(doubted(2.0, kStep));
  CHECK(doubted(2.0, kStep + 5));
  CHECK_FALSE(doubted(2.0, kStep - 1));
  CHECK_FALSE(doubted(2.0, kStep + 12));
  CHECK_FALSE(doubted(-2.0, kStep + 5));
  CHECK_FALSE(doubted(5.0, kStep + 5));  // more than a set-point's step explains
  CHECK_FALSE(doubted(2.0, 0));
  signals.setpoints.row(kStep - 11).setConstant(std::nan(""));
  CHECK_FALSE(doubted(2.0, kStep));  // it is not known where it was
}

// Nine steps of 1, 50 rows apart: eight besides the one that it comes with.
TEST_CASE("of a set-point that moves often one step comes with a move by chance, two do not") {
  constexpr Index kLong = 500, kHold = 50;
  const ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  Recording signals = test::recording_of(VectorXd::Zero(kLong), VectorXd::Zero(kLong));
  signals.setpoints = MatrixXd::Zero(kLong, 1);
  for (Index k = 0; k < kLong; ++k) signals.setpoints(k, 0) = static_cast<double>(k / kHold % 2);
  const auto step_at = [&](Index onset, double size) {
    Effect effect = of(causes::step_disturbance(), {0});
    effect.onset = onset;
    effect.coordinates = {{.value = size}};
    return Named{effect, 0.0, 0.0, {}};
  };
  const Named first = step_at(3 * kHold + 4, 2.0), second = step_at(5 * kHold + 2, 2.0);
  const auto doubted = [&](const std::vector<Named>& all) {
    return why_not_step(first.effect, all, model, signals) != nullptr;
  };
  CHECK_FALSE(doubted({first}));
  CHECK(doubted({first, second}));
  CHECK_FALSE(doubted({first, step_at(5 * kHold + 20, 2.0)}));  // it came long after
  CHECK_FALSE(doubted({first, step_at(4 * kHold + 2, 2.0)}));   // the other way
  signals.setpoints.bottomRows(kHold).setOnes();                // and in the end not back again
  signals.setpoints.middleRows(kLong - 2 * kHold, kHold).setOnes();
  CHECK(doubted({first}));
}

TEST_CASE("undecided, a CV's own set-point takes its share of the confidence in a channel") {
  const Bench wrong(1.5, 0.0), hidden(1.0, 1.0);
  CHECK_FALSE(own_setpoint_undecided(wrong.tests, 0));
  REQUIRE(own_setpoint_undecided(hidden.tests, 0));  // it wins, so that channels do not
  CHECK_FALSE(own_setpoint_undecided(hidden.tests, 1));
  Finding finding;
  finding.confidence = 1.0;
  add_own_setpoint(of(causes::gain(), {1, 1}), hidden.tests, kFirst, finding);
  add_own_setpoint(of(causes::gain(), {0, 0}), wrong.tests, kFirst, finding);
  add_own_setpoint(of(causes::step_disturbance(), {0}), hidden.tests, kFirst, finding);
  add_own_setpoint(setpoint(0, 1), hidden.tests, kFirst, finding);
  CHECK(finding.rivals.empty());
  add_own_setpoint(of(causes::gain(), {0, 0}), hidden.tests, kFirst, finding);
  REQUIRE(finding.rivals.size() == 1);
  CHECK(finding.rivals[0].subject == Subject{&causes::unmodelled_input(), {0, -1, 0}});
  CHECK(finding.rivals[0].inseparable);
  CHECK(finding.confidence == Approx(10.0 / 11.0));  // ten to one before any data
}

}  // namespace
}  // namespace mpm::setpoint_rival_test
