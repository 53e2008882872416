#include "core/identify/search/refine.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "tests/core/identify/proposals.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::refine_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 600;

struct Bench {
  Bench(const VectorXd& u, const VectorXd& y) : recording(test::recording_of(u, y)) {}
  Recording recording;
  Problem problem{test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1), 1, recording, Tolerances{},
                  NoiseModel{}};
  SearchSettings settings;
  std::vector<Effect> accepted;
  Trials trials{problem, settings, accepted, [] {}};
};

Effect gain(Index onset = 0) {
  return {&causes::gain(), {0, 0}, {{&kGainRatio, 1.0, 1.0, 0.25, 0.01, 0.02, 20.0}}, onset};
}

const Quantity& width_of_play() { return test::quantity_of(causes::deadband(), "width"); }
const Quantity& band() { return test::quantity_of(causes::stiction(), "band"); }
const Quantity& jump() { return test::quantity_of(causes::stiction(), "jump"); }

/// The valve's position by the play operator: it follows only what is beyond half the width.
VectorXd play(const VectorXd& u, double width) {
  VectorXd position = u;
  for (Index k = 1; k < u.size(); ++k)
    position(k) = std::clamp(position(k - 1), u(k) - 0.5 * width, u(k) + 0.5 * width);
  return position;
}

/// Sticks until its command is (S+J)/2 away, then slips to (S-J)/2 from it and moves on so while
/// the command keeps its direction (Choudhury, Thornhill and Shah 2005).
VectorXd sticking(const VectorXd& u, double band, double jump) {
  VectorXd position = u;
  double direction = 0.0;
  for (Index k = 1; k < u.size(); ++k) {
    position(k) = position(k - 1);
    const double move = u(k) - u(k - 1), away = u(k) - position(k);
    if (direction * move <= 0.0) direction = 0.0;
    if (direction == 0.0 && std::abs(away) > 0.5 * (band + jump))
      direction = away > 0.0 ? 1.0 : -1.0;
    if (direction != 0.0) position(k) = u(k) - direction * 0.5 * (band - jump);
  }
  return position;
}

/// Wanders, as a controller's output does.
VectorXd wandering() { return 0.3 * test::autoregressive(test::normal(8, kRows), 0.9); }

// The plant changes at a row that the test knows; the trial begins 45 rows off.
TEST_CASE("an onset is moved to where the plant changed") {
  const VectorXd u = test::telegraph(1, kRows, 12), y = test::first_order(u, 2.0, 10.0);
  for (const Index onset : {200, 355}) {
    CAPTURE(onset);
    VectorXd changed = y + 0.05 * test::white(2, kRows);
    changed.tail(kRows - onset) += 0.4 * y.tail(kRows - onset);
    Bench bench(u, changed);
    Trial trial = bench.trials.attempt(gain(onset - 45), 6);
    const double before = trial.odds;
    place_onset(bench.trials, trial);
    CHECK(trial.odds > before + 10.0);
    CHECK(std::abs(trial.candidate.onset - onset) <= 4);
    CHECK(trial.candidate.coordinates[0].value == Approx(1.4).margin(0.05));
  }
}

// A step's moment is nothing that a fit could shift: others are tried, ever closer.
TEST_CASE("a step is moved to its row") {
  const VectorXd u = test::telegraph(1, kRows, 12);
  VectorXd y = test::first_order(u, 2.0, 10.0) + 0.05 * test::white(2, kRows);
  y.tail(kRows - 317).array() += 0.4;
  Bench bench(u, y);
  Trial trial = bench.trials.attempt(
      {&causes::step_disturbance(), {0}, {{&kSize, 0.3, 0.0, 1.0, 0.01}}, 314}, 6);
  place_onset(bench.trials, trial);
  CHECK(trial.candidate.onset == 317);
  CHECK(trial.candidate.value(kSize, 0.0) == Approx(0.4).margin(0.05));
}

// From half as much again: the misfit has kinks at every reversal, and a fit alone stops early.
TEST_CASE("the width of a play is stepped to what it is") {
  const VectorXd u = wandering();
  const double width = 0.5;
  Bench bench(u, test::first_order(play(u, width), 2.0, 10.0) + 0.02 * test::white(5, kRows));
  Trial trial = bench.trials.attempt(
      {&causes::deadband(), {0, 0}, {{&width_of_play(), 1.5 * width, 0.0, 0.5, 0.01, 1e-4, 4.0}}},
      2);
  step_about(bench.trials, trial);
  CHECK(trial.candidate.coordinates[0].value == Approx(width).epsilon(0.03));
  CHECK(trial.odds > 100.0);
  // No width within a per cent of it is likelier.
  for (const double by : {0.99, 1.01}) {
    Effect other = trial.candidate;
    other.coordinates[0].value *= by;
    CHECK(bench.trials.attempt(other, 0).odds <= trial.odds + 1e-6);
  }
}

TEST_CASE("the two widths of a sticking valve are stepped to what they are") {
  const VectorXd u = wandering();
  const double true_band = 0.5, true_jump = 0.35;
  Bench bench(u, test::first_order(sticking(u, true_band, true_jump), 2.0, 10.0) +
                     0.02 * test::white(9, kRows));
  Trial trial = bench.trials.attempt(
      {&causes::stiction(),
       {0, 0},
       {{&band(), 0.6, 0.0, 0.5, 0.03, 1e-4, 4.0}, {&jump(), 0.28, 0.0, 0.5, -0.03, 0.0, 4.0}}},
      0);
  step_about(bench.trials, trial);
  CHECK(trial.candidate.value(band(), 0.0) == Approx(true_band).epsilon(0.03));
  CHECK(trial.candidate.value(jump(), 0.0) == Approx(true_jump).epsilon(0.05));
}

TEST_CASE("a smooth cause is not stepped about") {
  const VectorXd u = test::telegraph(1, kRows, 12);
  Bench bench(u, 1.2 * test::first_order(u, 2.0, 10.0) + 0.05 * test::white(2, kRows));
  Trial trial = bench.trials.attempt(gain(), 6);
  const double odds = trial.odds;
  step_about(bench.trials, trial);
  CHECK(trial.odds == odds);
}

TEST_CASE("a square wave's edges are stepped to the row") {
  const double period = 53.0, begin = 10.0;
  const VectorXd u = test::telegraph(1, kRows, 12);
  const VectorXd wave = VectorXd::NullaryExpr(kRows, [&](Index k) {
    const double phase = (static_cast<double>(k) - begin) / period;
    return phase - std::floor(phase) < 0.5 ? 0.5 : -0.5;
  });
  Bench bench(u, test::first_order(u, 2.0, 10.0) + wave + 0.1 * test::white(6, kRows));
  const Cause& periodic = causes::periodic_disturbance();
  const Quantity &begins = test::quantity_of(periodic, "begin"),
                 &periods = test::quantity_of(periodic, "period");
  Trial trial =
      bench.trials.attempt({&periodic,
                            {0},
                            {{&kSize, 0.4, 0.0, 1.0, 0.02},
                             {&begins, begin + 2.0, begin + 2.0, 13.0, 1.0},
                             {&periods, period + 0.25, period + 0.25, 9.0, 4.5, 25.0, 100.0}}},
                           2);
  step_about(bench.trials, trial);
  CHECK(trial.candidate.value(kSize, 0.0) == Approx(0.5).epsilon(0.05));
  // An edge lies between two rows, so neither is told to better than one; the period by one row in
  // all of its cycles.
  CHECK(std::abs(trial.candidate.value(begins, 0.0) - begin) <= 1.0);
  CHECK(std::abs(trial.candidate.value(periods, 0.0) - period) <= 2.0 * period / kRows);
}

// A valve that slips: plain play of about its width explains it nearly as well, and a fit from
// there never finds the slip.
TEST_CASE("where a play explains most, sticking valves near it are tried") {
  const VectorXd u = wandering();
  const double true_band = 0.5, true_jump = 0.35;
  Bench bench(u, test::first_order(sticking(u, true_band, true_jump), 2.0, 10.0) +
                     0.02 * test::white(9, kRows));
  const Effect dead{
      &causes::deadband(), {0, 0}, {{&width_of_play(), 0.4, 0.0, 0.5, 0.01, 1e-4, 4.0}}};
  const Effect valve{
      &causes::stiction(),
      {0, 0},
      {{&band(), 0.2, 0.0, 0.5, 0.01, 1e-4, 4.0}, {&jump(), 0.02, 0.0, 0.5, -0.01, 0.0, 4.0}}};
  std::vector<Trial> trials = {bench.trials.attempt(dead, 6), bench.trials.attempt(valve, 2)};
  std::sort(trials.begin(), trials.end(), more_probable);
  const std::vector<CvFit> without = bench.trials.without({0}).cvs;
  Screening screening(bench.problem, {}, without);
  look_closer(bench.trials, screening, trials);
  REQUIRE(trials.size() == 8);
  const Trial& best = *std::max_element(
      trials.begin(), trials.end(), [](const Trial& a, const Trial& b) { return a.odds < b.odds; });
  CHECK(best.candidate.edit == &causes::stiction());
  CHECK(best.candidate.value(band(), 0.0) == Approx(true_band).epsilon(0.1));
  CHECK(best.candidate.value(jump(), 0.0) == Approx(true_jump).epsilon(0.2));
}

TEST_CASE("without a play or a valve ahead no valves are tried") {
  const VectorXd u = test::telegraph(1, kRows, 12);
  Bench bench(u, 1.2 * test::first_order(u, 2.0, 10.0) + 0.05 * test::white(2, kRows));
  std::vector<Trial> trials = {bench.trials.attempt(gain(), 6)};
  const std::vector<CvFit> without = bench.trials.without({0}).cvs;
  Screening screening(bench.problem, {}, without);
  look_closer(bench.trials, screening, trials);
  CHECK(trials.size() == 1);
}

}  // namespace
}  // namespace mpm::refine_test
