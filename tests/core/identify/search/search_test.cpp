#include "core/identify/search/search.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::search_test {
namespace {

using Eigen::Index;
using test::lag;

constexpr Index kRows = 900;

// A gain in one CV and a time constant in the other: the truth is the test's own.
TEST_CASE("a search names one cause after the other and then ends") {
  Eigen::MatrixXd u(kRows, 2), y(kRows, 2);
  u << test::telegraph(1, kRows, 12), test::telegraph(3, kRows, 9);
  y.col(0) = 1.3 * test::first_order(u.col(0), 2.0, 10.0) + 0.1 * test::white(4, kRows);
  y.col(1) = test::first_order(u.col(1), -1.0, 10.0) + 0.1 * test::white(5, kRows);
  const ModelSpec two = test::model_of({lag(0, 0, 2.0, 10.0), lag(1, 1, -1.0, 5.0)}, 2, 2);
  const Recording recording = test::recording_of(u, y);
  Problem problem(two, 2, recording, Tolerances{}, NoiseModel{});
  const SearchResult found = search(problem, SearchSettings{});
  REQUIRE(found.named.size() == 2);
  CHECK(found.fit.effects.size() == 2);
  for (const Named& named : found.named) {
    CHECK(named.evidence > 3.0);
    CHECK(named.confidence > 0.9);
    if (named.effect.place.cv == 0) {
      CHECK(subject_of(named.effect) == Subject{&causes::gain(), {0, 0}});
      CHECK(named.effect.value(kGainRatio, 1.0) == Approx(1.3).margin(0.03));
    } else {
      CHECK(subject_of(named.effect) == Subject{&causes::time_constant(), {1, 1}});
      CHECK(std::exp(named.effect.value(kTimeConstantRatio, 0.0)) == Approx(2.0).margin(0.2));
    }
  }
  SearchSettings one;
  one.max_findings = 1;
  CHECK(search(problem, one).named.size() == 1);
}

// Each of seven loops has a gain of its own that is wrong, 1.4 times the model's.
TEST_CASE("as many causes are named as a plant of seven CVs has") {
  constexpr Index kCvs = 7, kFewRows = 400;
  Eigen::MatrixXd u(kFewRows, kCvs), y(kFewRows, kCvs);
  std::vector<ChannelSpec> channels;
  for (Index i = 0; i < kCvs; ++i) {
    const auto stream = static_cast<std::uint64_t>(i);
    u.col(i) = test::telegraph(11 + stream, kFewRows, 12);
    y.col(i) =
        1.4 * test::first_order(u.col(i), 2.0, 5.0) + 0.1 * test::white(31 + stream, kFewRows);
    channels.push_back(lag(static_cast<int>(i), static_cast<int>(i), 2.0, 5.0));
  }
  const Recording recording = test::recording_of(u, y);
  Problem problem(test::model_of(channels, kCvs, kCvs), kCvs, recording, Tolerances{},
                  NoiseModel{});
  const SearchResult found = search(problem, SearchSettings{});
  for (int cv = 0; cv < kCvs; ++cv) {
    CAPTURE(cv);
    CHECK(std::any_of(found.named.begin(), found.named.end(), [cv](const Named& named) {
      return named.effect.place.cv == cv &&
             named.effect.value(kGainRatio, 1.0) == Approx(1.4).margin(0.05);
    }));
  }
}

// The same gain error in each of two CVs that share nothing: neither is what the other might be.
TEST_CASE("what is as wrong in another CV is no rival") {
  Eigen::MatrixXd u(kRows, 2), y(kRows, 2);
  u << test::telegraph(1, kRows, 12), test::telegraph(3, kRows, 12);
  y.col(0) = 1.3 * test::first_order(u.col(0), 2.0, 10.0) + 0.1 * test::white(4, kRows);
  y.col(1) = 1.3 * test::first_order(u.col(1), 2.0, 10.0) + 0.1 * test::white(5, kRows);
  const ModelSpec two = test::model_of({lag(0, 0, 2.0, 10.0), lag(1, 1, 2.0, 10.0)}, 2, 2);
  const Recording recording = test::recording_of(u, y);
  Problem problem(two, 2, recording, Tolerances{}, NoiseModel{});
  const SearchResult found = search(problem, SearchSettings{});
  REQUIRE(found.named.size() == 2);
  for (const Named& named : found.named) {
    CHECK(named.confidence > 0.9);
    for (const Rival& rival : named.rivals) {
      CAPTURE(rival.subject.place.cv, rival.subject.place.input);
      CHECK((rival.subject.place.cv < 0 || rival.subject.place.cv == named.effect.place.cv));
    }
  }
}

// The suspect is looked for with nuisances beside what was found; the fit had them without it. A
// channel more has three more of them.
TEST_CASE("what a search has fitted can be read with the problem that it leaves") {
  const Eigen::VectorXd u = test::telegraph(1, kRows, 12), left_out = test::telegraph(2, kRows, 9);
  const Eigen::VectorXd y = test::first_order(u, 2.0, 10.0) +
                            test::first_order(left_out, 1.0, 5.0) + 0.1 * test::white(4, kRows);
  Recording recording = test::recording_of(u, y);
  recording.aux = left_out;
  const ModelSpec model = with_aux_inputs(test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1), recording);
  Problem problem(model, 1, recording, Tolerances{}, NoiseModel{});
  SearchSettings settings;
  settings.max_findings = 1;
  settings.may_name = [](const Effect&) { return true; };
  const SearchResult found = search(problem, settings);
  REQUIRE(found.named.size() == 1);
  CHECK(found.named[0].effect.edit == &causes::unmodelled_input());
  REQUIRE(found.fit.cvs.size() == 1);
  CHECK(found.fit.cvs[0].beta.size() == problem.data(0).nuisances.cols());
  const CvFit& fit = found.fit.cvs[0];
  const CvData& data = problem.data(0);
  const Eigen::VectorXd left =
      data.measured - problem.simulate(found.fit.effects, 0) - data.nuisances * fit.beta;
  CHECK((left.cwiseProduct(data.known) - fit.residual).norm() < 1e-9 * fit.residual.norm());
}

// A level of 2 beside a gain of 1.3 times the model's, which by itself would shift the CV too: with
// no levels to be named it is told where the gain is, and not where that may not be either.
TEST_CASE("a level is told beside what is wrong with a channel, else only where it may be") {
  const Eigen::VectorXd u = test::telegraph(1, kRows, 12);
  const Eigen::VectorXd y =
      (1.3 * test::first_order(u, 2.0, 10.0) + 0.1 * test::white(4, kRows)).array() + 2.0;
  const ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  const Recording recording = test::recording_of(u, y);
  const auto levels = [&](const std::function<bool(const Effect&)>& may_name) {
    Problem problem(model, 1, recording, Tolerances{}, NoiseModel{});
    SearchSettings settings;
    settings.may_name = may_name;
    std::vector<double> sizes;
    for (const Named& named : search(problem, settings).named)
      if (causes::is_constant_offset(named.effect))
        sizes.push_back(named.effect.coordinates[0].value);
    return sizes;
  };
  const auto no_level = [](const Effect& effect) { return !causes::is_constant_offset(effect); };
  const std::vector<double> beside = levels(no_level);
  REQUIRE(beside.size() == 1);
  CHECK(beside[0] == Approx(2.0).margin(0.05));
  CHECK(levels([&](const Effect& effect) {
          return no_level(effect) && !cause_of(effect).acts_through_channels();
        }).empty());
}

/// In how many of 12 records with such noise a step is named.
int steps_named(const std::function<Eigen::VectorXd(std::uint64_t seed)>& noise) {
  const ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  int named = 0;
  for (std::uint64_t seed = 40; seed < 52; ++seed) {
    const Eigen::VectorXd u = test::telegraph(seed, kRows, 12);
    const Recording recording =
        test::recording_of(u, test::first_order(u, 2.0, 10.0) + noise(seed + 100));
    Problem problem(model, 1, recording, Tolerances{}, NoiseModel{});
    for (const Named& each : search(problem, SearchSettings{}).named)
      named += each.effect.edit == &causes::step_disturbance() && each.effect.onset > 0 ? 1 : 0;
  }
  return named;
}

// Without the shock's row what speaks for a step is that without one the noise would have to be a
// walk: n (1 - p) / (1 + p) = 33 for a pole of 0.93. Of that a search among all rows (900 / 4
// moments) would take 11, and the priors of size and noise some 10: 3 of the 12 were named so. A
// shock that dies away as all of the noise does leaves nothing of the kind.
TEST_CASE("a step is named where a shock tells its row and the level stays, not where it dies away",
          "[trials]") {
  constexpr Index kShock = 450;
  constexpr double kInnovation = 0.1, kPole = 0.93;
  const auto innovations = [&](std::uint64_t seed) {
    return Eigen::VectorXd(kInnovation * test::normal(seed, kRows));
  };
  CHECK(steps_named([&](std::uint64_t seed) {
          Eigen::VectorXd noise = test::autoregressive(innovations(seed), kPole);
          noise.tail(kRows - kShock).array() += 2.0;
          return noise;
        }) >= 8);
  CHECK(steps_named([&](std::uint64_t seed) {
          Eigen::VectorXd shocks = innovations(seed);
          shocks(kShock) += 2.0;
          return test::autoregressive(shocks, kPole);
        }) <= 2);
}

// As above, but the CV jumps by nearly as much at other rows too, as where a valve slips again and
// again: no shock tells the step's row then, and the search among all takes 11 of the evidence.
TEST_CASE("among shocks of its size a step's tells no row") {
  constexpr Index kShock = 450;
  constexpr double kInnovation = 0.1, kPole = 0.93;
  CHECK(steps_named([&](std::uint64_t seed) {
          Eigen::VectorXd shocks = kInnovation * test::normal(seed, kRows);
          for (const Index row : {150, 300, 600, 750}) shocks(row) += row % 4 == 0 ? 2.0 : -2.0;
          Eigen::VectorXd noise = test::autoregressive(shocks, kPole);
          noise.tail(kRows - kShock).array() += 2.4;
          return noise;
        }) <= 4);
}

/// What is found in a CV that wanders, all else of which is as the model has it. `shock`: at one
/// row, in s.d. of the walk's steps.
SearchResult found_in_walk(std::uint64_t seed, Index row, double shock) {
  const Eigen::VectorXd u = test::telegraph(seed, kRows, 12);
  Eigen::VectorXd steps = 0.1 * test::normal(seed + 100, kRows);
  steps(row) += 0.1 * shock;
  const Recording recording =
      test::recording_of(u, test::first_order(u, 2.0, 10.0) + test::autoregressive(steps, 1.0));
  const ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  Problem problem(model, 1, recording, Tolerances{}, NoiseModel{});
  return search(problem, SearchSettings{});
}

// Of a walk nobody can tell whether a shock of it or something else has moved it. That one row
// stands out by 10 s.d. is seen all the same: 100, less what the search (11) and the priors cost.
TEST_CASE("a shock of a walk is told as a step, or as one that is doubted; a walk alone is not") {
  constexpr Index kShock = 450;
  int told = 0;
  for (std::uint64_t seed = 60; seed < 72; ++seed) {
    CAPTURE(seed);
    const SearchResult found = found_in_walk(seed, kShock, 10.0);
    const std::optional<Named> step = found.named.empty() ? found.doubted : found.named.front();
    told += step && step->evidence > 30.0 && step->effect.onset == kShock ? 1 : 0;
    const SearchResult nothing = found_in_walk(seed, kShock, 0.0);
    CHECK(nothing.named.empty());
    CHECK((!nothing.doubted || nothing.doubted->evidence < 30.0));
  }
  CHECK(told >= 9);
}

// A shock of 60 s.d. in noise that forgets by a fifth a sample looks like a jump that passes at
// first, and like nothing without its row. The search used to end there.
TEST_CASE("a shock that is no jump hides nothing else") {
  int gains = 0;
  for (std::uint64_t seed = 80; seed < 92; ++seed) {
    const Eigen::VectorXd u = test::telegraph(seed, kRows, 12);
    Eigen::VectorXd shocks = 0.1 * test::normal(seed + 100, kRows);
    shocks(450) += 6.0;
    const Recording recording = test::recording_of(
        u, 1.1 * test::first_order(u, 2.0, 10.0) + test::autoregressive(shocks, 0.8));
    const ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
    Problem problem(model, 1, recording, Tolerances{}, NoiseModel{});
    for (const Named& named : search(problem, SearchSettings{}).named)
      gains += named.effect.edit == &causes::gain() ? 1 : 0;
  }
  CHECK(gains >= 9);
}

}  // namespace
}  // namespace mpm::search_test
