#include "core/identify/search/trial.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/proposals.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::trial_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 600;

ModelSpec model() {
  return test::model_of({lag(0, 0, 2.0, 10.0), lag(1, 0, 1.0, 5.0), lag(1, 1, -3.0, 8.0)}, 2, 2);
}

/// The first input acts with `first`, the second with `second` times the gain.
Recording plant(double first, double second, const VectorXd& added = VectorXd::Zero(kRows)) {
  MatrixXd u(kRows, 2), y(kRows, 2);
  u << test::telegraph(1, kRows, 12), test::telegraph(2, kRows, 9);
  y.col(0) = first * test::first_order(u.col(0), 2.0, 10.0) + 0.05 * test::white(3, kRows) + added;
  y.col(1) = first * test::first_order(u.col(0), 1.0, 5.0) +
             second * test::first_order(u.col(1), -3.0, 8.0) + 0.05 * test::white(4, kRows);
  return test::recording_of(u, y);
}

Effect gain(const Cause& cause, int cv, int input, double start = 1.0) {
  return {&cause, {cv, input}, {{&kGainRatio, start, 1.0, 0.25, 0.01, 0.02, 20.0}}};
}

struct Bench {
  explicit Bench(const Recording& data) : recording(data) {}
  Recording recording;
  Problem problem{model(), 2, recording, Tolerances{}, NoiseModel{}};
  SearchSettings settings;
  std::vector<Effect> accepted;
  int told = 0;
  Trials trials{problem, settings, accepted, [this] { ++told; }};
};

// Gains off by 20 % beside noise of a fortieth of what the inputs do: beyond doubt. 3 % are beyond
// doubt too, but no more than what every model is wrong by (5 %).
TEST_CASE("what nobody would care about is never more likely than not") {
  Bench large(plant(1.0, 1.2));
  const Trial wrong = large.trials.attempt(gain(causes::gain(), 1, 1), 6);
  CHECK(wrong.odds > 50.0);
  CHECK(wrong.candidate.coordinates[0].value == Approx(1.2).margin(0.02));
  Bench small(plant(1.0, 1.03));
  const Trial slight = small.trials.attempt(gain(causes::gain(), 1, 1), 6);
  CHECK(slight.candidate.coordinates[0].value == Approx(1.03).margin(0.01));
  CHECK(slight.odds <= 0.0);
  // And so is 20 % where 30 % are what nobody minds.
  large.settings.materiality.gain = 0.3;
  CHECK(large.trials.attempt(gain(causes::gain(), 1, 1), 6).odds == 0.0);
  Bench none(plant(1.0, 1.0));
  CHECK(none.trials.attempt(gain(causes::gain(), 1, 1), 6).odds < 0.0);
}

// A disturbance of 1 % of the CV's s.d. is not visible, one of 10 % is (1.5 % is the rule).
TEST_CASE("a disturbance must move its CV visibly") {
  const VectorXd sine = VectorXd::NullaryExpr(
      kRows, [](Index k) { return std::sin(2.0 * M_PI * 20.0 * double(k) / double(kRows)); });
  const Cause& cause = causes::periodic_disturbance();
  const Quantity &sines = test::quantity_of(cause, "sine"),
                 &cosines = test::quantity_of(cause, "cosine"),
                 &frequency = test::quantity_of(cause, "frequency");
  const auto attempt = [&](double size) {
    Bench bench(plant(1.0, 1.0, size * sine));
    const double w = 20.0 / double(kRows);
    const Effect periodic{&cause,
                          {0},
                          {{&sines, size, 0.0, size, 0.01 * size},
                           {&cosines, 0.0, 0.0, size, 0.01 * size},
                           {&frequency, w, w, 1e-3, 1e-6}}};
    bench.settings.visible = 0.015;
    return bench.trials.attempt(periodic, 4);
  };
  CHECK(attempt(0.2).odds > 20.0);
  CHECK(attempt(0.02).odds <= 0.0);
}

TEST_CASE("the odds are those of a fit with against one without") {
  Bench bench(plant(1.0, 1.2));
  const Fit& without = bench.trials.without({1});
  CHECK(without.effects.empty());
  REQUIRE(without.cvs.size() == 1);
  CHECK(without.cvs[0].cv == 1);
  CHECK(&bench.trials.without({1}) == &without);  // remembered
  // White noise, a cause that is not rare and cost no search: the fall of the cost.
  const Trial trial = bench.trials.attempt(gain(causes::gain(), 1, 1), 6);
  CHECK(trial.odds == Approx(without.cost - trial.fit.cost).margin(1e-6));
  Effect dear = gain(causes::gain(), 1, 1);
  dear.search_cost = 11.0;
  CHECK(bench.trials.attempt(dear, 6).odds == Approx(trial.odds - 11.0).margin(1e-6));
  CHECK(bench.told == 2);
}

// An input's scale acts on both CVs, so that a trial on the second alone must leave it as it is; a
// gain of the second CV alone is fitted along.
TEST_CASE("accepted effects that reach beyond the candidate's CVs stay as they are") {
  Bench bench(plant(1.2, 1.2));
  bench.accepted = {gain(causes::input_scale(), -1, 0, 1.17), gain(causes::gain(), 1, 1, 1.1)};
  Effect later = gain(causes::time_constant(), 1, 0);
  later.coordinates = {{&kTimeConstantRatio, 0.1, 0.0, 0.35, 0.01, -2.5, 2.5}};
  const Trial trial = bench.trials.attempt(later, 6);
  REQUIRE(trial.fit.effects.size() == 3);
  CHECK(trial.fit.effects[0].coordinates[0].value == 1.17);
  CHECK(trial.fit.effects[1].coordinates[0].value == Approx(1.2).margin(0.02));
  CHECK(subject_of(trial.fit.effects[2]) == subject_of(later));
  CHECK(trial.fit.covariance.rows() == 2);
}

TEST_CASE("settling forgets the fits before it") {
  Bench bench(plant(1.0, 1.0));
  const double empty = bench.trials.without({1}).cost;
  bench.accepted = {gain(causes::gain(), 1, 1, 1.3)};
  bench.trials.settle(nullptr);
  const Fit& anew = bench.trials.without({1});
  REQUIRE(anew.effects.size() == 1);
  CHECK(anew.effects[0].coordinates[0].value == Approx(1.0).margin(0.02));
  CHECK(anew.cost > empty - 1.0);
}

TEST_CASE("telling may end it all") {
  Bench bench(plant(1.0, 1.0));
  struct Stop {};
  Trials stopping(bench.problem, bench.settings, bench.accepted, [] { throw Stop(); });
  CHECK_THROWS_AS(stopping.attempt(gain(causes::gain(), 1, 1), 6), Stop);
}

}  // namespace
}  // namespace mpm::trial_test
