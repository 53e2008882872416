#include "core/identify/fit/problem.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "tests/core/identify/proposals.hpp"
#include "tests/core/identify/small_plant.hpp"
#include "tests/core/oracle.hpp"

namespace mpm::problem_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 400;

/// The two CVs of tests/oracles/identify_fit.py, as they are in the model.
ModelSpec two_cvs() {
  return test::model_of(
      {lag(0, 0, 2.0, 10.0, 2.0), lag(0, 1, -1.0, 5.0), lag(1, 0, 1.5, 20.0, 3.0)}, 2, 2);
}

MatrixXd two_inputs() {
  MatrixXd inputs(kRows, 2);
  inputs << test::telegraph(1, kRows, 12), test::telegraph(2, kRows, 9);
  return inputs;
}

VectorXd noise(int cv) {
  return test::autoregressive(0.1 * test::white(static_cast<std::uint64_t>(20 + cv), kRows), 0.6);
}

/// The plant: the first input acts with other numbers on a CV than the model says.
Recording measured(double gain_ratio, double time_constant_ratio = 1.0, Index later = 0) {
  const MatrixXd u = two_inputs();
  MatrixXd cvs(kRows, 2);
  cvs.col(0) =
      test::first_order(u.col(0), 2.0 * gain_ratio, 10.0 * time_constant_ratio, 2 + later) +
      test::first_order(u.col(1), -1.0, 5.0) + noise(0);
  cvs.col(1) =
      test::first_order(u.col(0), 1.5 * gain_ratio, 20.0 * time_constant_ratio, 3 + later) +
      noise(1);
  return test::recording_of(u, cvs);
}

const Coordinate kGain{&kGainRatio, 1.0, 1.0, 0.25, 0.01, 0.02, 20.0};
const Coordinate kLogTimeConstant{&kTimeConstantRatio, 0.0, 0.0, 0.35, 0.01, -2.5, 2.5};
const Coordinate kDeadTime{&kDeadTimeError, 0.3, 0.0, 3.0, 0.25, -3.0, 60.0};

Effect gain_of(const Place& place) { return {&causes::gain(), place, {kGain}}; }

/// A Gauss-Newton fit ends where a step is no longer worth its while: a twentieth of an s.d.
void check_fit(const Fit& fit, const nlohmann::json& expected) {
  const std::vector<Coordinate>& found = fit.effects.back().coordinates;
  const auto values = expected["values"].get<std::vector<double>>();
  const auto covariance = expected["covariance"].get<std::vector<std::vector<double>>>();
  REQUIRE(found.size() == values.size());
  REQUIRE(fit.covariance.rows() == static_cast<Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    CAPTURE(found[i].quantity->name);
    CHECK(found[i].value == Approx(values[i]).margin(0.05 * std::sqrt(covariance[i][i])));
    for (std::size_t j = 0; j < values.size(); ++j)
      CHECK(fit.covariance(static_cast<Index>(i), static_cast<Index>(j)) ==
            Approx(covariance[i][j]).margin(0.02 * std::sqrt(covariance[i][i] * covariance[j][j])));
  }
}

void check_noise_and_cost(const Fit& fit, const nlohmann::json& expected) {
  const nlohmann::json& noise = expected["noise"];
  REQUIRE(fit.cvs.size() == noise.size());
  for (std::size_t i = 0; i < noise.size(); ++i) {
    CHECK(fit.cvs[i].variance == Approx(noise[i]["variance"].get<double>()).epsilon(1e-3));
    const auto coefficients = noise[i]["coefficients"].get<std::vector<double>>();
    for (std::size_t l = 0; l < coefficients.size(); ++l)
      CHECK(fit.cvs[i].noise.coefficients(static_cast<Index>(l)) ==
            Approx(coefficients[l]).margin(0.01));
  }
  // In 2 ln odds, of which three decide.
  CHECK(fit.misfit == Approx(expected["misfit"].get<double>()).margin(0.05));
  CHECK(fit.complexity == Approx(expected["complexity"].get<double>()).margin(0.05));
  CHECK(fit.cost == Approx(fit.misfit + fit.complexity));
}

TEST_CASE("a number that two CVs share is fitted to both") {
  const nlohmann::json expected = test::read_oracle("identify_fit.json")["input_scale"];
  const Recording recording = measured(1.2);
  Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
  const Fit fit = problem.fit({{&causes::input_scale(), {-1, 0}, {kGain}}}, 0, {0, 1});
  check_fit(fit, expected);
  check_noise_and_cost(fit, expected);
}

TEST_CASE("numbers that bend the simulation are fitted with their covariance") {
  const nlohmann::json expected = test::read_oracle("identify_fit.json")["dynamics"];
  const Recording recording = measured(0.9, 1.3, 1);
  Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
  const Effect effect{&causes::dynamics(), {1, 0}, {kGain, kLogTimeConstant, kDeadTime}};
  const Fit fit = problem.fit({effect}, 0, {1});
  check_fit(fit, expected);
  check_noise_and_cost(fit, expected);
}

TEST_CASE("rows that were not measured take no part, nor do those that have them as past") {
  const nlohmann::json expected = test::read_oracle("identify_fit.json")["unknown_rows"];
  Recording recording = measured(1.2);
  for (const Index k : {100, 101, 102, 103, 104, 250})
    recording.cvs(k, 0) = std::numeric_limits<double>::quiet_NaN();
  Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
  const Fit fit = problem.fit({gain_of({0, 0})}, 0, {0});
  check_fit(fit, expected);
  check_noise_and_cost(fit, expected);
}

TEST_CASE("without an effect the small errors and the noise are fitted") {
  const nlohmann::json expected = test::read_oracle("identify_fit.json")["nothing"];
  const Recording recording = measured(1.0);
  Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
  const Fit fit = problem.fit({}, 0, {0});
  check_noise_and_cost(fit, expected);
  // By its definition: with no effects there is nothing to judge otherwise.
  CHECK(problem.cost_with_noise_of(fit, {}) ==
        Approx(problem.data(0).rows + fit.complexity).margin(0.05));
}

// With the noise held everything is linear and normal. The data alone say ratio r +- s; with the
// effect there is that ratio, without it only the tolerance t: (r - 1)^2 / (t^2 + s^2) dearer, and
// ln (1 + t^2 / s^2) for what the tolerance then learns.
TEST_CASE("with the noise held, leaving a cause out costs what its tolerance cannot take") {
  const Recording recording = measured(1.2);
  Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
  const Fit fit = problem.fit({gain_of({0, 0})}, 0, {0});
  const double prior = 0.25 * 0.25, tolerance = 0.02 * 0.02;
  const double posterior = fit.covariance(0, 0), data = 1.0 / (1.0 / posterior - 1.0 / prior);
  const double fitted = fit.effects[0].coordinates[0].value;
  const double of_data = (fitted / posterior - 1.0 / prior) * data;
  const double expected = std::pow(of_data - 1.0, 2) / (tolerance + data) +
                          std::log(1.0 + tolerance / data) - std::pow(of_data - fitted, 2) / data;
  CHECK(problem.cost_with_noise_of(fit, {}) - problem.cost_with_noise_of(fit, fit.effects) ==
        Approx(expected).epsilon(0.01));
}

TEST_CASE("coordinates that are not free stay, and bounds hold") {
  const Recording recording = measured(1.2);
  Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
  Effect held{&causes::time_constant(), {0, 1}, {kLogTimeConstant}};
  held.coordinates[0].value = 0.1;
  Effect bounded = gain_of({0, 0});
  bounded.coordinates[0].high = 1.1;
  const Fit fit = problem.fit({held, bounded}, 1, {0});
  CHECK(fit.effects[0].coordinates[0].value == 0.1);
  CHECK(fit.effects[1].coordinates[0].value == 1.1);
  CHECK(fit.covariance.rows() == 1);
}

TEST_CASE("an effect's search cost is part of what its fit costs") {
  const Recording recording = measured(1.2);
  Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
  Effect effect = gain_of({0, 0});
  const double cost = problem.fit({effect}, 0, {0}).cost;
  effect.search_cost = 7.0;
  CHECK(problem.fit({effect}, 0, {0}).cost == Approx(cost + 7.0));
}

TEST_CASE("a start that is no model costs without end") {
  const Recording recording = measured(1.2);
  Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
  const auto number = [](const char* name, double value) {
    return Coordinate{&test::quantity_of(causes::unmodelled_input(), name), value, 0.0, 1.0, 0.1};
  };
  const Effect effect{&causes::unmodelled_input(),
                      {0, 1},
                      {number("gain", 1.0), number("time_constant", std::nan(""))}};
  CHECK(problem.fit({effect}, 0, {0}).cost == std::numeric_limits<double>::infinity());
}

// A plant that changes its gain at row 200: before it the model is right, from it on the other is.
TEST_CASE("an effect acts from its onset on") {
  const Recording recording = measured(1.0);
  Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
  Effect effect = gain_of({0, 0});
  effect.onset = 200;
  effect.coordinates[0].value = 1.5;
  const MatrixXd u = two_inputs();
  const VectorXd first = test::first_order(u.col(0), 2.0, 10.0, 2);
  const VectorXd other = test::first_order(u.col(1), -1.0, 5.0);
  const VectorXd simulated = problem.simulate({effect}, 0);
  CHECK(simulated.head(200).isApprox((first + other).head(200), 1e-10));
  CHECK(simulated.tail(200).isApprox((1.5 * first + other).tail(200), 1e-10));
  CHECK(problem.simulate({effect}, 1).isApprox(test::first_order(u.col(0), 1.5, 20.0, 3), 1e-10));
}

// d (ratio K h * u) / d ratio = K h * u, times the prior's s.d.
TEST_CASE("a sensitivity is per prior s.d.") {
  const Recording recording = measured(1.0);
  Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
  Effect effect = gain_of({0, 0});
  const VectorXd expected = 0.25 * test::first_order(two_inputs().col(0), 2.0, 10.0, 2);
  const auto sensitivity = [&] {
    return problem.sensitivity({effect}, 0, 0, 0, problem.simulate({effect}, 0));
  };
  CHECK(sensitivity().isApprox(expected, 1e-9));
  effect.coordinates[0].value = effect.coordinates[0].high = 1.0;  // looked at from below
  CHECK(sensitivity().isApprox(expected, 1e-9));
}

// Noise of a tenth of what the change moves the CV by: its row is found nearly to the row.
TEST_CASE("the best onset is where the plant changed") {
  const MatrixXd u = two_inputs();
  for (const Index onset : {130, 200, 290}) {
    CAPTURE(onset);
    Recording recording = measured(1.0);
    const VectorXd more = 0.4 * test::first_order(u.col(0), 2.0, 10.0, 2);
    recording.cvs.col(0).tail(kRows - onset) += more.tail(kRows - onset);
    Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
    Effect effect = gain_of({0, 0});
    effect.onset = onset + 12;
    const Fit fit = problem.fit({effect}, 0, {0});
    CHECK(std::abs(problem.best_onset(fit, onset - 60, onset + 60) - onset) <= 2);
  }
}

TEST_CASE("weights say which rows count") {
  Recording recording = measured(1.0);
  recording.cvs(50, 0) = std::numeric_limits<double>::quiet_NaN();
  const Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
  const CvData& data = problem.data(0);
  for (Index k = 0; k < kRows; ++k) {
    const bool has_past = k >= 8 && (k < 50 || k > 58);
    CHECK(data.weights(k) == (has_past ? 1.0 : 0.0));
    CHECK(data.known(k) == (k == 50 ? 0.0 : 1.0));
  }
  CHECK(data.rows == 400.0 - 8.0 - 9.0);
  CHECK(data.measured(50) == 0.0);
  CHECK(problem.data(1).rows == 392.0);
}

// Of a first-order channel around its model, by hand: 2 % of its response, and what three per cent
// of time constant and a tenth of a row move it by.
TEST_CASE("small errors are scaled by their tolerances") {
  const Recording recording = measured(1.0);
  const Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
  const CvData& data = problem.data(1);
  REQUIRE(data.meaning.size() == 5);  // level, first state, three of the channel
  const VectorXd u = two_inputs().col(0);
  CHECK(data.meaning[0].input == -1);
  CHECK(data.nuisances.col(0).isApproxToConstant(data.nuisances(0, 0), 0.0));
  CHECK(data.meaning[1].input == -1);
  CHECK(data.meaning[2].input == 0);
  CHECK(data.nuisances.col(2).isApprox(0.02 * test::first_order(u, 1.5, 20.0, 3), 1e-9));
  const VectorXd slower =
      test::first_order(u, 1.5, 20.0 * std::exp(1e-4), 3) - test::first_order(u, 1.5, 20.0, 3);
  CHECK(data.nuisances.col(3).isApprox(0.03 * slower / 1e-4, 0.02));
  const VectorXd base = test::first_order(u, 1.5, 20.0, 3),
                 later = test::first_order(u, 1.5, 20.0, 4);
  CHECK(data.nuisances.col(4).isApprox(0.1 * (later - base), 0.1));
  for (Index k = 0; k + 1 < kRows; ++k)
    CHECK(data.nuisances(k + 1, 1) == Approx(data.nuisances(k, 1) * std::exp(-1.0 / 20.0)));
}

TEST_CASE("settling with a fit weighs its rows, with a step's own shock in them") {
  Recording recording = measured(1.0);
  recording.cvs.col(1).tail(200).array() += 5.0;  // a step, which whitened is a shock
  Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
  const Effect step{
      &causes::step_disturbance(), {1}, {{&kSize, 5.0, 0.0, 10.0, 0.1, -1e12, 1e12}}, 200};
  const Fit with = problem.fit({step}, 0, {1});
  CHECK(with.effects[0].coordinates[0].value == Approx(5.0).epsilon(0.1));
  problem.settle({step}, &with);
  const CvData& data = problem.data(1);
  CHECK(data.weights(200) < 0.05);  // 3 s.d. of 50, squared
  CHECK(data.weights.mean() == Approx(392.0 / 400.0).epsilon(1e-9));
  CHECK(problem.data(0).weights(200) == 1.0);
  problem.settle({}, nullptr);
  CHECK(problem.data(1).weights(200) == 1.0);
}

TEST_CASE("a CV that clips is known where it does not") {
  Recording recording = measured(1.0);
  recording.cvs.col(0) = recording.cvs.col(0).cwiseMin(1.5);
  const auto clipped = (recording.cvs.col(0).array() == 1.5).count();
  REQUIRE(clipped > 20);
  const Problem problem(two_cvs(), 2, recording, Tolerances{}, NoiseModel{});
  CHECK_FALSE(problem.plateaus(0).low);
  CHECK(problem.plateaus(0).high == 1.5);
  CHECK_FALSE(problem.plateaus(1).high);
  CHECK(problem.data(0).known.sum() == Approx(double(kRows - clipped)));
  CHECK(problem.data(1).known.sum() == Approx(double(kRows)));
}

TEST_CASE("an effect touches the CVs of its channels") {
  const Recording recording = test::recording_of(two_inputs(), MatrixXd::Zero(kRows, 2));
  const Problem problem(
      test::model_of({lag(0, 0, 2.0, 10.0), lag(1, 0, 1.0, 5.0), lag(1, 1, -3.0, 8.0)}, 2, 2), 2,
      recording, Tolerances{}, NoiseModel{});
  const auto of_input = [&](int input) {
    return touched({&causes::input_scale(), {-1, input}, {kGain}}, problem);
  };
  CHECK(of_input(0) == std::vector<int>{0, 1});
  CHECK(of_input(1) == std::vector<int>{1});
  CHECK(touched(gain_of({1, 0}), problem) == std::vector<int>{1});
}

// By hand: 1 - 0.5 q^-1 on 2, 4, (unknown), 4, over an s.d. of 2, weights 0, 1, 4, 1.
TEST_CASE("rows are whitened, weighted and in s.d.") {
  CvData data;
  data.known = Eigen::Vector4d(1.0, 1.0, 0.0, 1.0);
  data.weights = Eigen::Vector4d(0.0, 1.0, 4.0, 1.0);
  CvFit fit;
  fit.noise.coefficients = VectorXd::Constant(1, 0.5);
  fit.variance = 4.0;
  CHECK(WhitenedRows(data, fit)(Eigen::Vector4d(2.0, 4.0, 9.0, 4.0))
            .isApprox(Eigen::Vector4d(0.0, 1.5, -2.0, 2.0), 1e-14));
}

}  // namespace
}  // namespace mpm::problem_test
