#include "core/identify/diagnosis/verdict.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Finding finding_of(double evidence, const char* refused) {
  Finding finding;
  finding.subject = {&causes::gain(), {0, 0}};
  finding.evidence = evidence;
  finding.refused = refused;
  return finding;
}

DiagnosisVerdict verdict_of(Diagnosis diagnosis, const FreeRunVerdict& free_runs = {}) {
  decide(free_runs, diagnosis);
  // Whatever is left open says why.
  CHECK(diagnosis.reason.empty() == (diagnosis.verdict != DiagnosisVerdict::kUndetermined));
  return diagnosis.verdict;
}

TEST_CASE("a match is a model that explains, and that nothing speaks against") {
  CHECK(verdict_of({}) == DiagnosisVerdict::kMatch);
  CHECK(verdict_of({}, {.explained = 0.05}) == DiagnosisVerdict::kUndetermined);
  CHECK(verdict_of({}, {.sticks = true}) == DiagnosisVerdict::kUndetermined);
  CHECK(verdict_of({}, {.loses = true}) == DiagnosisVerdict::kUndetermined);
  Diagnosis diagnosis;
  diagnosis.refused = {finding_of(10.0, "weak")};
  CHECK(verdict_of(diagnosis) == DiagnosisVerdict::kMatch);
  diagnosis.refused.push_back(finding_of(40.0, "strong"));
  CHECK(verdict_of(diagnosis) == DiagnosisVerdict::kUndetermined);
  diagnosis.findings = {finding_of(5.0, "")};
  CHECK(verdict_of(diagnosis) == DiagnosisVerdict::kMismatch);
}

TEST_CASE("the reason is that of the strongest that was refused") {
  Diagnosis diagnosis;
  diagnosis.refused = {finding_of(50.0, "strong"), finding_of(40.0, "weaker")};
  decide({}, diagnosis);
  CHECK(diagnosis.reason == "what explains most was refused: strong");
}

TEST_CASE("what no linear model fits and nothing names leaves the verdict open") {
  Diagnosis diagnosis;
  diagnosis.bent = {{0, 0}};
  decide({.explained = 0.9}, diagnosis);
  CHECK(diagnosis.verdict == DiagnosisVerdict::kUndetermined);
  CHECK(
      diagnosis.reason ==
      "what these channels do no linear model explains; of the known causes none was sure enough");
}

TEST_CASE("what the calibrated test surely rejects and nothing names leaves the verdict open") {
  Diagnosis diagnosis;
  diagnosis.rejected = {{0, 0}};
  decide({.explained = 0.9}, diagnosis);
  CHECK(diagnosis.verdict == DiagnosisVerdict::kUndetermined);
  CHECK(diagnosis.reason ==
        "a model that matches would not be rejected so; what is wrong is not told");
}

TEST_CASE("only a strong suspect leaves the verdict open") {
  Diagnosis diagnosis;
  diagnosis.suspect = finding_of(20.0, "");
  CHECK(verdict_of(diagnosis) == DiagnosisVerdict::kMatch);
  diagnosis.suspect = finding_of(40.0, "");
  CHECK(verdict_of(diagnosis) == DiagnosisVerdict::kUndetermined);
}

// A 95 % interval of 0.06 either side is an s.d. of 0.03.
TEST_CASE("a model is no match whose gain is off by its own estimate") {
  const auto with_gain = [](double value, double reach) {
    Diagnosis diagnosis;
    diagnosis.channels.resize(2);
    for (ChannelEstimate& channel : diagnosis.channels)
      channel.gain_ratio = {&kGainRatio, 1.0, 0.9, 1.1};
    diagnosis.channels[1].gain_ratio = {&kGainRatio, value, value - reach, value + reach};
    return diagnosis;
  };
  CHECK(verdict_of(with_gain(0.83, 0.06)) == DiagnosisVerdict::kUndetermined);
  CHECK(verdict_of(with_gain(1.17, 0.06)) == DiagnosisVerdict::kUndetermined);
  CHECK(verdict_of(with_gain(1.24, 0.12)) == DiagnosisVerdict::kUndetermined);  // 1.12 at least
  CHECK(verdict_of(with_gain(1.24, 0.15)) == DiagnosisVerdict::kMatch);
  CHECK(verdict_of(with_gain(0.83, 0.12)) == DiagnosisVerdict::kMatch);
  CHECK(verdict_of(with_gain(1.08, 0.01)) == DiagnosisVerdict::kMatch);  // small
}

// y = 1, -1, 1, -1: variance 1. Left of it 0.5, -0.5, ...: a quarter. A constant error counts not.
TEST_CASE("the share that a model explains is of what a CV does beyond a constant") {
  MatrixXd cvs(4, 2), residuals(4, 2);
  cvs << 1, 1, -1, -1, 1, 1, -1, -1;
  residuals << 0.5, 7, -0.5, 7, 0.5, 7, -0.5, 7;
  CHECK(least_explained(residuals, cvs) == Approx(0.75));
  residuals.col(0).setConstant(kNaN);  // not measured
  CHECK(least_explained(residuals, cvs) == Approx(1.0));
}

// Errors of 1 about 5 in four rows, then of 3 off that level: nine times the mean square, and more
// than the CV's own 1 about its mean, or not.
TEST_CASE("a model loses a CV whose errors grow beyond what the CV does") {
  VectorXd cv(8), error(8);
  cv << 1, -1, 1, -1, 1, -1, 1, -1;
  error << 6, 4, 6, 4, 8, 8, 8, 8;
  CHECK(loses_a_cv(error, cv, 4));
  CHECK_FALSE(loses_a_cv(error, 10.0 * cv, 4));
  CHECK_FALSE(loses_a_cv(error, cv, 8));
  error.tail(4) << 6.2, 3.8, 6.2, 3.8;  // 1.44 times
  CHECK_FALSE(loses_a_cv(error, cv, 4));
  error.tail(4).setConstant(kNaN);
  CHECK_FALSE(loses_a_cv(error, cv, 4));
}

TEST_CASE("what diverges or is hardly known is not judged") {
  MatrixXd residuals = MatrixXd::Zero(100, 1);
  CHECK(why_not_judged(residuals).empty());
  residuals(50, 0) = 1e300;
  CHECK(why_not_judged(residuals).find("diverge") != std::string::npos);
  residuals.topRows(91).setConstant(kNaN);
  CHECK(why_not_judged(residuals).find("unknown") != std::string::npos);
}

TEST_CASE("a loop without a set-point, or that does not swing, does not stick") {
  const ModelSpec model = test::model_of({test::lag(0, 0, 2.0, 10.0)}, 1, 1);
  Recording recording = test::recording_of(test::white(1, 1000), test::white(2, 1000));
  CHECK(sticking_loops(model, 1, recording).empty());
  recording.setpoints = MatrixXd::Zero(1000, 1);
  CHECK(sticking_loops(model, 1, recording).empty());
}

}  // namespace
}  // namespace mpm
