#include "core/identify/measured_gain.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/diagnosis/extension.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm {
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
  Diagnosis diagnosis;
  DiagnosisSettings settings;

  Bench(double fitted, double unseen)
      : all(plant(fitted, unseen)),
        first(test::recording_of(all.inputs.topRows(kFitted), all.cvs.topRows(kFitted))),
        problem(model, 2, first, Tolerances{}, NoiseModel{}) {
    settings.progress = [](double) { return true; };
    diagnosis.samples = kRows;
    diagnosis.fit_samples = kFitted;
    diagnosis.validation_samples = kRows - kFitted;
    diagnosis.extended = model;
  }

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
    Effect gain;
    gain.subject = {Cause::kGain, 0, 0, -1, ""};
    gain.coordinates = {{"gain_ratio", 1.0, 1.0, 0.25, 0.01, 0.02, 20.0}};
    found.fit = problem.fit({gain}, 0, {0, 1}, 10);
    found.named = {{found.fit.effects[0], 80.0, 1.0, {}}};
    diagnosis.findings = {to_finding(found, 0, problem)};
  }

  void measure(const Recording* validation = nullptr) {
    measure_gain(problem, found, model, model, all, validation, settings, diagnosis);
  }
};

double rms(const VectorXd& values) { return std::sqrt(values.cwiseAbs2().mean()); }

// What the extended model leaves is the noise, whose rms over 300 rows is known to 2.6 %.
TEST_CASE("a repair that carries over is measured on rows that no fit has seen") {
  Bench bench(1.5, 1.5);
  bench.find_gain();
  bench.measure();
  REQUIRE(bench.diagnosis.scores.size() == 2);
  const CvScore& repaired = bench.diagnosis.scores[0];
  const VectorXd response = test::first_order(bench.all.inputs.col(0), 2.0, 10.0);
  CHECK(repaired.rmse_before ==
        Approx(rms((0.5 * response + kNoise * test::white(3, kRows)).tail(300))).epsilon(0.01));
  CHECK(repaired.rmse_after == Approx(kNoise).epsilon(0.08));
  const double gain = 1.0 - repaired.rmse_after / repaired.rmse_before;
  CHECK(repaired.gain_low < gain);
  CHECK(repaired.gain_high > gain);
  CHECK(repaired.gain_low > 0.5);
  CHECK_FALSE(repaired.refused);
  CHECK(bench.diagnosis.findings.size() == 1);
  CHECK(bench.diagnosis.findings[0].repaired);
  CHECK(bench.diagnosis.refused.empty());
  CHECK(std::get<TransferFunction>(bench.diagnosis.extended.channels[0].dynamics).gain ==
        Approx(3.0).epsilon(0.02));

  const CvScore& other = bench.diagnosis.scores[1];
  CHECK(other.rmse_after == other.rmse_before);
  CHECK(other.gain_low == 0.0);
  CHECK(other.gain_high == 0.0);
  CHECK(bench.diagnosis.before.rows() == kRows);
  CHECK(bench.diagnosis.after.col(1) == bench.diagnosis.before.col(1));
  CHECK(bench.diagnosis.validation_before.size() == 0);
}

TEST_CASE("a repair that makes the unseen rows worse is refused") {
  Bench bench(1.5, 1.0);
  bench.find_gain();
  bench.measure();
  CHECK(bench.diagnosis.findings.empty());
  REQUIRE(bench.diagnosis.refused.size() == 1);
  CHECK(bench.diagnosis.refused[0].subject.cause == Cause::kGain);
  CHECK_FALSE(bench.diagnosis.refused[0].repaired);
  CHECK(bench.diagnosis.scores[0].refused);
  CHECK(bench.diagnosis.scores[0].rmse_after == bench.diagnosis.scores[0].rmse_before);
  CHECK(std::get<TransferFunction>(bench.diagnosis.extended.channels[0].dynamics).gain == 2.0);
  CHECK(bench.diagnosis.after == bench.diagnosis.before);
}

TEST_CASE("a second recording is what no fit has seen") {
  Bench bench(1.5, 1.5);
  bench.find_gain();
  const Recording unseen = Bench::plant(1.0, 1.0);  // there the model is right
  bench.diagnosis.validation_samples = kRows;
  bench.measure(&unseen);
  CHECK(bench.diagnosis.refused.size() == 1);
  CHECK(bench.diagnosis.validation_before.rows() == kRows);
  CHECK(bench.diagnosis.scores[0].rmse_before == Approx(kNoise).epsilon(0.08));
  CHECK(rms(bench.all.cvs.col(0) - bench.diagnosis.before.col(0)) > 0.5);
}

// What has no name repairs nothing, and what the data show to the last digit is not asked.
TEST_CASE("what is certain stays and what has no name is no repair") {
  Bench bench(1.0, 1.0);
  Named clipping;
  clipping.effect.subject = {Cause::kOutputNonlinearity, 0, -1, -1, "saturation"};
  clipping.effect.coordinates = {{"high", 100.0}};
  clipping.effect.certain = true;
  Named unnamed;
  unnamed.effect.subject = {Cause::kUnnamed, 0, 0, -1, "direction"};
  bench.found.named = {clipping, unnamed};
  bench.measure();
  CHECK(bench.diagnosis.extended.output_blocks[0].has_value());
  CHECK(bench.diagnosis.refused.empty());
  CHECK_FALSE(bench.diagnosis.scores[0].refused);
}

}  // namespace
}  // namespace mpm
