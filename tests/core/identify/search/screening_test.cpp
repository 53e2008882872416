#include "core/identify/search/screening.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/proposals.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::screening_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 250;

/// A plant whose gain is 1.3 times the model's.
struct Bench {
  VectorXd u = test::telegraph(1, kRows, 12);
  VectorXd response = test::first_order(u, 2.0, 10.0);
  ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  Recording recording = test::recording_of(
      u, 1.3 * response + test::autoregressive(0.2 * test::white(2, kRows), 0.5));
  Problem problem{model, 1, recording, Tolerances{}, NoiseModel{}};
};

Effect gain(double start) {
  return {&causes::gain(), {0, 0}, {{&kGainRatio, start, 1.0, 0.25, 0.01, 0.02, 20.0}}};
}

Effect shaped(const VectorXd& shape, double sd) {
  const Quantity& part = test::quantity_of(causes::unnamed_swing(), "part");
  Effect effect{&causes::unnamed_swing(), {0, 0}, {{&part, 0.0, 0.0, sd, 0.1 * sd, -1e3, 1e3}}};
  effect.shape = std::make_shared<MatrixXd>(shape);
  return effect;
}

/// 2 ln of the odds for one number of prior mean 0 that adds `per_sd` to the CV per prior s.d., by
/// Bayes: the small errors (and what was accepted) are normal too, so that the rows have the
/// covariance I + N N'. The noise's variance is what it is with and without.
double by_bayes(const Problem& problem, const CvFit& fit, const VectorXd& simulated,
                const VectorXd& per_sd, const MatrixXd& accepted) {
  const CvData& data = problem.data(0);
  const WhitenedRows rows_of(data, fit);
  MatrixXd small(kRows, data.nuisances.cols() + accepted.cols());
  for (Index b = 0; b < data.nuisances.cols(); ++b) small.col(b) = rows_of(data.nuisances.col(b));
  for (Index b = 0; b < accepted.cols(); ++b)
    small.col(data.nuisances.cols() + b) = rows_of(accepted.col(b));
  const MatrixXd covariance = MatrixXd::Identity(kRows, kRows) + small * small.transpose();
  const Eigen::LLT<MatrixXd> inverse(covariance);
  const VectorXd residual = rows_of(data.measured - simulated);
  const VectorXd z = rows_of(per_sd);
  const double before = residual.dot(inverse.solve(residual));
  const double information = z.dot(inverse.solve(z)), right = z.dot(inverse.solve(residual));
  const double size = right / (1.0 + information);
  const double after = before - 2.0 * size * right + size * size * information;
  return data.rows * std::log(before / after) - size * size - std::log(1.0 + information);
}

TEST_CASE("a candidate's score is its odds by Bayes where all is linear") {
  Bench bench;
  const std::vector<CvFit> without = bench.problem.fit({}, 0, {0}).cvs;
  Screening screening(bench.problem, {}, without);
  const auto expected = [&](const VectorXd& per_sd) {
    return by_bayes(bench.problem, without[0], bench.response, per_sd, MatrixXd(kRows, 0));
  };
  const double of_gain = expected(0.25 * bench.response);
  CHECK(of_gain > 10.0);
  CHECK(screening.score(gain(1.0)) == Approx(of_gain).epsilon(1e-6));
  // Linear: one step comes to the same from anywhere.
  CHECK(screening.score(gain(1.6)) == Approx(of_gain).epsilon(1e-6));
  const VectorXd nothing = test::white(5, kRows);
  CHECK(screening.score(shaped(nothing, 0.5)) == Approx(expected(0.5 * nothing)).epsilon(1e-6));
  CHECK(screening.score(shaped(nothing, 0.5)) < 2.0);
}

TEST_CASE("what was accepted is looked at beside a candidate") {
  Bench bench;
  const Fit fit = bench.problem.fit({gain(1.0)}, 0, {0});
  Screening screening(bench.problem, fit.effects, fit.cvs);
  const VectorXd per_sd = 0.2 * test::white(7, kRows) + 0.3 * bench.response;
  const double ratio = fit.effects[0].coordinates[0].value;
  CHECK(screening.score(shaped(per_sd, 1.0)) ==
        Approx(by_bayes(bench.problem, fit.cvs[0], ratio * bench.response, per_sd,
                        0.25 * bench.response))
            .epsilon(1e-6));
}

TEST_CASE("the search is paid for, and what touches nothing or is no model is told") {
  Bench bench;
  const std::vector<CvFit> without = bench.problem.fit({}, 0, {0}).cvs;
  Screening screening(bench.problem, {}, without);
  Effect effect = gain(1.0);
  const double score = screening.score(effect);
  effect.search_cost = 9.0;
  CHECK(screening.score(effect) == Approx(score - 9.0));
  // Nothing moves: odds of 1, less what the search cost.
  effect = shaped(VectorXd::Zero(kRows), 1.0);
  effect.search_cost = 4.0;
  CHECK(screening.score(effect) == Approx(-4.0));
  effect = gain(1.0);
  effect.edit = &causes::time_constant();
  effect.coordinates = {{&kTimeConstantRatio, std::nan(""), 0.0, 0.35, 0.01, -2.5, 2.5}};
  CHECK(screening.score(effect) < -1e100);
}

}  // namespace
}  // namespace mpm::screening_test
