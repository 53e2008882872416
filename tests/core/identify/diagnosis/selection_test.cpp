#include "core/identify/diagnosis/selection.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/extension.hpp"
#include "tests/core/identify/proposals.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::selection_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

constexpr Index kFitted = 600, kRows = 900;
constexpr double kNoise = 0.1;

/// The first input acts with `fitted` times its gain in the rows that are fitted, with `unseen`
/// times in the others; the second CV is as the model says.
struct Bench {
  ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0), lag(1, 1, 1.0, 5.0)}, 2, 2);
  Recording all, first;
  Problem problem;
  SearchResult found;
  int told = 0;

  Bench(double fitted, double unseen)
      : all(plant(fitted, unseen)),
        first(part(all, 0, kFitted)),
        problem(model, 2, first, Tolerances{}, NoiseModel{}) {}

  static Recording plant(double fitted, double unseen) {
    MatrixXd u(kRows, 2), y(kRows, 2);
    u << test::telegraph(1, kRows, 12), test::telegraph(2, kRows, 9);
    const VectorXd response = test::first_order(u.col(0), 2.0, 10.0);
    y.col(0) = response + kNoise * test::white(3, kRows);
    y.col(0).head(kFitted) += (fitted - 1.0) * response.head(kFitted);
    y.col(0).tail(kRows - kFitted) += (unseen - 1.0) * response.tail(kRows - kFitted);
    y.col(1) = test::first_order(u.col(1), 1.0, 5.0) + kNoise * test::white(4, kRows);
    return test::recording_of(u, y);
  }

  void find_gain() {
    const Effect gain{&causes::gain(), {0, 0}, {{&kGainRatio, 1.0, 1.0, 0.25, 0.01, 0.02, 20.0}}};
    found.fit = problem.fit({gain}, 0, {0, 1}, 10);
    found.named = {{found.fit.effects[0], 80.0, 1.0, {}}};
  }

  Selection select_on(const Recording& recording, Index rows) {
    Unseen unseen(recording, rows, model, 1);
    return select(problem, found, {unseen, 0, {}, {1.0, 1.0}}, [this] { ++told; });
  }
};

TEST_CASE("a repair that carries over is taken") {
  Bench bench(1.5, 1.5);
  bench.find_gain();
  const Selection selection = bench.select_on(bench.all, kRows - kFitted);
  CHECK(selection.fates == std::vector<Fate>{Fate::kRepaired});
  CHECK(selection.order == std::vector<std::size_t>{0});
  CHECK(repaired(selection) == std::vector<bool>{true});
  // Before, the error is half the response and noise; after, noise: telegraphs of 12 samples
  // through a lag of 10 leave the response with an s.d. of 1.4, so 0.01 / (0.49 + 0.01) stays.
  CHECK(selection.explains[0] == Approx(0.98).margin(0.02));
  CHECK(bench.told > 0);
}

TEST_CASE("a repair that makes the unseen rows worse is refused") {
  Bench bench(1.5, 1.0);
  bench.find_gain();
  const Selection selection = bench.select_on(bench.all, kRows - kFitted);
  CHECK(selection.fates == std::vector<Fate>{Fate::kRefused});
  CHECK(repaired(selection) == std::vector<bool>{false});
}

TEST_CASE("a second recording is what no fit has seen") {
  Bench bench(1.5, 1.5);
  bench.find_gain();
  const Recording unseen = Bench::plant(1.0, 1.0);  // there the model is right
  CHECK(bench.select_on(unseen, kRows).fates == std::vector<Fate>{Fate::kRefused});
}

// What has no name repairs nothing, and what the data show to the last digit is not asked.
TEST_CASE("what is certain stays and what has no name is no repair") {
  Bench bench(1.0, 1.0);
  Named clipping;
  const Quantity& high = test::quantity_of(causes::output_saturation(), "high");
  clipping.effect = {&causes::output_saturation(), {0}, {{&high, 100.0}}};
  clipping.effect.certain = true;
  Named unnamed;
  unnamed.effect = {&causes::unnamed_direction(), {0, 0}, {}};
  bench.found.named = {clipping, unnamed};
  const Selection selection = bench.select_on(bench.all, kRows - kFitted);
  CHECK(selection.fates == std::vector<Fate>{Fate::kRepaired, Fate::kNoBetter});
  const ModelSpec extended = extend(bench.problem, bench.found, repaired(selection), {true, true});
  CHECK(extended.output_blocks[0].has_value());
}

// Shifts by -s and s from the same row, where the truth is 0.49 s: the second one is clearly better
// beside the first, the first beside the second hardly, and so it goes; the second alone is worse
// than none, 0.51^2 to 0.49^2.
TEST_CASE(
    "a disturbance that was good beside one that has gone goes too where it is worse than none") {
  Bench bench(1.0, 1.0);
  constexpr double kShift = 0.2;
  constexpr Index kOnset = 100;
  bench.all.cvs.col(0).tail(kRows - kOnset).array() += 0.49 * kShift;
  const Quantity& size = test::quantity_of(causes::step_disturbance(), "size");
  for (const auto& [shift, evidence] : {std::pair{kShift, 20.0}, std::pair{-kShift, 80.0}}) {
    Named named;
    named.effect = {&causes::step_disturbance(), {0}, {{&size, shift}}};
    named.effect.onset = kOnset;
    named.evidence = evidence;
    bench.found.named.push_back(named);
    bench.found.fit.effects.push_back(named.effect);
  }
  const Selection selection = bench.select_on(bench.all, kRows - kFitted);
  CHECK(selection.fates == std::vector<Fate>{Fate::kNoBetter, Fate::kNoBetter});
}

// Of a jump of 1 in noise of 0.1 that passes with a time constant of 50 s, and of one of 500 s.
TEST_CASE("of what had passed before the unseen rows they say nothing") {
  const auto fate_of = [](double decay_s) {
    Bench bench(1.0, 1.0);
    const Quantity& size = test::quantity_of(causes::step_disturbance(), "size");
    const Quantity& decay = test::quantity_of(causes::step_disturbance(), "decay");
    Named named;
    named.effect = {&causes::step_disturbance(), {0}, {{&size, 1.0}, {&decay, std::log(decay_s)}}};
    named.effect.onset = 100;
    for (Index k = named.effect.onset; k < kRows; ++k)
      bench.all.cvs(k, 0) += std::exp(-static_cast<double>(k - named.effect.onset) / decay_s);
    bench.found.named = {named};
    bench.found.fit.effects = {named.effect};
    return bench.select_on(bench.all, kRows - kFitted).fates;
  };
  CHECK(fate_of(50.0) == std::vector<Fate>{Fate::kOver});
  CHECK(fate_of(500.0) == std::vector<Fate>{Fate::kRepaired});
}

// Two inputs that move alike: 1.5 times the gain of one and 0.4 times that of the other leave an
// error of a tenth where none was; without either of them it is half as large as the response.
TEST_CASE("repairs that are better beside each other and worse than none are refused") {
  Bench bench(1.0, 1.0);
  bench.all.inputs.col(1) = bench.all.inputs.col(0);
  bench.model.channels[1] = lag(0, 1, 2.0, 10.0);
  bench.all.cvs.col(0) += test::first_order(bench.all.inputs.col(0), 2.0, 10.0);
  bench.first = part(bench.all, 0, kFitted);
  Problem problem(bench.model, 2, bench.first, Tolerances{}, NoiseModel{});
  SearchResult found;
  found.fit = problem.fit({}, 0, {0, 1});
  for (const auto& [input, ratio] : {std::pair{0, 1.5}, std::pair{1, 0.4}})
    found.named.push_back(
        {{&causes::gain(), {0, input}, {{&kGainRatio, ratio}}}, 80.0 - input, 1.0, {}});
  Unseen unseen(bench.all, kRows - kFitted, bench.model, 1);
  const OpenChannels closed = [](int, int, bool) { return false; };
  const Selection selection = select(problem, found, {unseen, 0, closed, {0.1, 0.1}}, [] {});
  CHECK(selection.fates == std::vector<Fate>{Fate::kRefused, Fate::kRefused});
}

// The input's scale is 1.5 for the first CV and 1 for the second. In squares, with an answer of
// s.d. 1.4 and 0.7 and noise of 0.1: the first CV's error falls from 0.50 to 0.01, the second's
// rises from 0.01 to 0.13. In units of what is left that is 50 against 1 in one and 0.08 against 1
// in the other.
TEST_CASE("a repair of all of an input's channels is judged in all of them") {
  Bench bench(1.5, 1.5);
  bench.model.channels[1] = lag(1, 0, 1.0, 10.0);
  bench.all.cvs.col(1) =
      test::first_order(bench.all.inputs.col(0), 1.0, 10.0) + kNoise * test::white(4, kRows);
  bench.first = part(bench.all, 0, kFitted);
  Problem problem(bench.model, 2, bench.first, Tolerances{}, NoiseModel{});
  SearchResult found;
  found.fit = problem.fit({}, 0, {0, 1});
  found.named = {{{&causes::input_scale(), {-1, 0}, {{&kGainRatio, 1.5}}}, 80.0, 1.0, {}}};
  Unseen unseen(bench.all, kRows - kFitted, bench.model, 1);
  const OpenChannels closed = [](int, int, bool) { return false; };
  const Selection selection = select(problem, found, {unseen, 0, closed, {1.0, 1.0}}, [] {});
  CHECK(selection.fates == std::vector<Fate>{Fate::kRepaired});
}

// A controller undoes what disturbs the CV: y = G u + d with u nearly -d / G. Of a model with half
// the plant's gain the free run is off by d + G u / 2, about half of d; of the plant's own by d. So
// free runs and predictions speak against the true gain, and it is not to be refused by them.
TEST_CASE("what is worse only because the controller saw it is not refused") {
  Bench bench(1.0, 1.0);
  constexpr double kGain = 4.0;  // twice the model's
  const VectorXd disturbance = test::autoregressive(0.1 * test::normal(7, kRows), 0.995);
  const VectorXd outside = 0.1 * test::telegraph(8, kRows, 12);
  const double pole = std::exp(-1.0 / 10.0);
  VectorXd u = VectorXd::Zero(kRows), y = u;
  double state = 0.0, integral = 0.0;
  for (Index k = 0; k < kRows; ++k) {
    y(k) = state + disturbance(k);
    integral -= 0.02 * y(k);
    u(k) = integral - 0.1 * y(k) + outside(k);
    state = pole * state + kGain * (1.0 - pole) * u(k);
  }
  bench.all.inputs.col(0) = u;
  bench.all.cvs.col(0) = y + 0.02 * test::white(9, kRows);
  bench.first = part(bench.all, 0, kFitted);
  Problem problem(bench.model, 2, bench.first, Tolerances{}, NoiseModel{});
  SearchResult found;
  found.fit = problem.fit({}, 0, {0, 1});
  found.named = {{{&causes::gain(), {0, 0}, {{&kGainRatio, 2.0}}}, 80.0, 1.0, {}}};
  Unseen unseen(bench.all, kRows - kFitted, bench.model, 1);
  const VectorXd given = unseen.residual(bench.model, 0);
  ModelSpec plants = bench.model;
  std::get<TransferFunction>(plants.channels[0].dynamics).gain = kGain;
  const VectorXd own = unseen.residual(plants, 0);
  REQUIRE(own.squaredNorm() > 2.0 * given.squaredNorm());
  const OpenChannels closed = [](int, int, bool) { return false; };
  const Selection selection = select(problem, found, {unseen, 0, closed, {1.0, 1.0}}, [] {});
  CHECK(selection.fates == std::vector<Fate>{Fate::kNoBetter});
  // A gain that the plant does not have is refused as before.
  found.named[0].effect.coordinates[0].value = 0.5;
  const Selection wrong = select(problem, found, {unseen, 0, closed, {1.0, 1.0}}, [] {});
  CHECK(wrong.fates == std::vector<Fate>{Fate::kRefused});
}

// Two inputs that move nearly alike; 1.5 times the gain of one and half that of the other are true.
// Either of them alone leaves an error of half the response where the given model's is the half of
// the little by which the inputs differ.
TEST_CASE("of repairs that only make sense together each names the other") {
  Bench bench(1.0, 1.0);
  const VectorXd apart = 0.5 * bench.all.inputs.col(1);
  bench.all.inputs.col(1) = bench.all.inputs.col(0) + apart;
  bench.model.channels[1] = lag(0, 1, 2.0, 10.0);
  bench.all.cvs.col(0) = test::first_order(bench.all.inputs.col(0), 3.0, 10.0) +
                         test::first_order(bench.all.inputs.col(1), 1.0, 10.0) +
                         kNoise * test::white(3, kRows);
  bench.first = part(bench.all, 0, kFitted);
  Problem problem(bench.model, 2, bench.first, Tolerances{}, NoiseModel{});
  SearchResult found;
  found.fit = problem.fit({}, 0, {0, 1});
  for (const auto& [input, ratio] : {std::pair{0, 1.5}, std::pair{1, 0.5}})
    found.named.push_back(
        {{&causes::gain(), {0, input}, {{&kGainRatio, ratio}}}, 80.0 - input, 1.0, {}});
  Unseen unseen(bench.all, kRows - kFitted, bench.model, 1);
  const OpenChannels closed = [](int, int, bool) { return false; };
  const Selection selection = select(problem, found, {unseen, 0, closed, {1.0, 1.0}}, [] {});
  REQUIRE(selection.fates == std::vector<Fate>{Fate::kRepaired, Fate::kRepaired});
  CHECK(selection.with == std::vector<std::optional<std::size_t>>{1, 0});
}

TEST_CASE("a repair that stands by itself needs no other") {
  Bench bench(1.5, 1.5);
  bench.find_gain();
  Named other = bench.found.named[0];
  other.effect.place = {1, 1};
  bench.all.cvs.col(1) += test::first_order(bench.all.inputs.col(1), 0.5, 5.0);
  bench.found.named.push_back(other);
  const Selection selection = bench.select_on(bench.all, kRows - kFitted);
  REQUIRE(selection.fates == std::vector<Fate>{Fate::kRepaired, Fate::kRepaired});
  CHECK(selection.with == std::vector<std::optional<std::size_t>>{std::nullopt, std::nullopt});
}

TEST_CASE("the weakest evidence is judged first") {
  Bench bench(1.5, 1.5);
  bench.find_gain();
  Named other = bench.found.named[0];
  other.effect.place = {1, 1};
  other.effect.coordinates[0].value = 0.5;  // the second CV is as the model says
  other.evidence = 5.0;
  bench.found.named.push_back(other);
  const Selection selection = bench.select_on(bench.all, kRows - kFitted);
  CHECK(selection.order == std::vector<std::size_t>{1, 0});
  CHECK(selection.fates == std::vector<Fate>{Fate::kRepaired, Fate::kRefused});
}

}  // namespace
}  // namespace mpm::selection_test
