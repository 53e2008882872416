#include <catch2/catch.hpp>
#include <cmath>

#include "tests/hidden/report.hpp"
#include "tests/hidden/score.hpp"

namespace mpm::hidden {
namespace {

/// Two inputs on two CVs, and a third input on the first CV only.
HiddenCase blank_case(EffectClass effect_class, std::vector<TrueEffect> truth) {
  HiddenCase hidden;
  hidden.request.effect_class = effect_class;
  hidden.model.input_count = 3;
  hidden.model.cv_count = 2;
  for (const auto& [cv, input] : {std::pair(0, 0), {0, 1}, {1, 0}, {1, 1}, {0, 2}})
    hidden.model.channels.push_back({cv, input, TransferFunction{1.0, {10.0}}});
  hidden.data.cvs = Eigen::MatrixXd::Constant(30, 2, 2.0);
  hidden.noise_free = Eigen::MatrixXd::Zero(30, 2);
  hidden.truth = std::move(truth);
  hidden.evidence.assign(hidden.truth.size(), 100.0);
  return hidden;
}

TrueEffect effect(const Cause& cause, int cv, int input) {
  TrueEffect result;
  result.cause = &cause;
  result.place = {cv, input};
  return result;
}

Finding finding(const Cause& cause, int cv, int input, double confidence = 0.99) {
  Finding result;
  result.subject = {&cause, {cv, input}};
  result.confidence = confidence;
  return result;
}

Diagnosis mismatch(std::vector<Finding> findings) {
  Diagnosis diagnosis;
  diagnosis.verdict = DiagnosisVerdict::kMismatch;
  diagnosis.findings = std::move(findings);
  return diagnosis;
}

}  // namespace

TEST_CASE("the first finding's cause counts, the right place may come later") {
  const HiddenCase hidden = blank_case(EffectClass::kGain, {effect(causes::gain(), 0, 1)});
  const CaseScore right = score(hidden, mismatch({finding(causes::gain(), 0, 1)}), 1.0);
  CHECK(right.cause_right);
  CHECK(right.place_right == true);
  CHECK(right.extra == 0);
  CHECK(right.named == "gain");
  const CaseScore elsewhere = score(hidden, mismatch({finding(causes::gain(), 1, 0)}), 1.0);
  CHECK(elsewhere.cause_right);
  CHECK(elsewhere.place_right == false);
  const CaseScore later =
      score(hidden, mismatch({finding(causes::gain(), 1, 0), finding(causes::gain(), 0, 1)}), 1.0);
  CHECK(later.cause_right);
  CHECK(later.place_right == true);
  CHECK(later.extra == 1);
  const CaseScore second = score(
      hidden, mismatch({finding(causes::noise(), 0, -1), finding(causes::gain(), 0, 1)}), 1.0);
  CHECK_FALSE(second.cause_right);
  CHECK(second.extra == 1);
  CHECK_FALSE(score(hidden, mismatch({finding(causes::dynamics(), 0, 1)}), 1.0).cause_right);
}

TEST_CASE("the only channel of an input has two names for its gain") {
  const HiddenCase hidden = blank_case(EffectClass::kGain, {effect(causes::gain(), 0, 2)});
  const CaseScore said = score(hidden, mismatch({finding(causes::input_scale(), -1, 2)}), 1.0);
  CHECK(said.cause_right);
  CHECK(said.place_right == true);
  CHECK_FALSE(score(hidden, mismatch({finding(causes::output_scale(), 0, -1)}), 1.0).cause_right);
}

TEST_CASE("dynamics may be said in parts on the same channel") {
  const HiddenCase hidden = blank_case(EffectClass::kDynamics, {effect(causes::dynamics(), 0, 1)});
  const CaseScore said = score(
      hidden, mismatch({finding(causes::gain(), 0, 1), finding(causes::dead_time(), 0, 1)}), 1.0);
  CHECK(said.cause_right);
  CHECK(said.place_right == true);
  CHECK(said.extra == 0);
  CHECK_FALSE(score(hidden, mismatch({finding(causes::gain(), 0, 1)}), 1.0).cause_right);
}

TEST_CASE("of two causes both must be named") {
  const HiddenCase hidden =
      blank_case(EffectClass::kTwoCauses,
                 {effect(causes::stiction(), -1, 0), effect(causes::drift_disturbance(), 1, -1)});
  const Finding drift = finding(causes::step_disturbance(), 1, -1);
  const CaseScore both = score(
      hidden, mismatch({drift, finding(causes::gain(), 0, 1), finding(causes::stiction(), -1, 0)}),
      1.0);
  CHECK(both.cause_right);
  CHECK(both.place_right == true);
  CHECK(both.kind_right == false);
  CHECK(both.extra == 1);
  CHECK_FALSE(score(hidden, mismatch({drift}), 1.0).cause_right);
}

TEST_CASE("nothing hidden, and what has no name") {
  Diagnosis match;
  match.verdict = DiagnosisVerdict::kMatch;
  const HiddenCase none = blank_case(EffectClass::kNone, {});
  CHECK(score(none, match, 1.0).cause_right);
  CHECK(score(none, match, 1.0).named == "none");
  CHECK_FALSE(score(none, Diagnosis{}, 1.0).cause_right);
  CHECK(score(none, mismatch({finding(causes::gain(), 0, 0)}), 1.0).extra == 1);

  TrueEffect nameless;
  nameless.place.cv = 1;
  const HiddenCase unnamed = blank_case(EffectClass::kUnnamed, {nameless});
  CHECK_FALSE(score(unnamed, match, 1.0).cause_right);
  CHECK_FALSE(score(unnamed, mismatch({finding(causes::gain(), 1, 0)}), 1.0).cause_right);
  CHECK(score(unnamed, mismatch({finding(causes::gain(), 1, 0, 0.5)}), 1.0).place_right == true);
  Diagnosis located = mismatch({});
  CHECK(score(unnamed, located, 1.0).place_right == false);
  located.unexplained.push_back({{&causes::unnamed_swing(), {1}}, 0.0, 0.5});
  CHECK(score(unnamed, located, 1.0).cause_right);
  CHECK(score(unnamed, located, 1.0).place_right == true);
  CHECK(score(unnamed, located, 1.0).named == "unnamed");
}

TEST_CASE("parameters, onset and what is left of the error") {
  TrueEffect gain = effect(causes::gain(), 0, 0);
  gain.parameters["gain_ratio"] = 0.8;
  gain.onset_s = 500.0;
  HiddenCase hidden = blank_case(EffectClass::kOnsetGain, {gain});
  hidden.data.sample_time_s = 10.0;
  Finding said = finding(causes::gain(), 0, 0);
  said.parameters = {{&kGainRatio, 0.82, 0.79, 0.85}, {&kDampingRatio, 1.0, 0.0, 2.0}};
  said.onset_s = 530.0;
  Diagnosis diagnosis = mismatch({said});
  diagnosis.fit_samples = 20;
  diagnosis.scores.resize(2);
  for (CvScore& cv : diagnosis.scores) {
    cv.rmse_before = 6.0;
    cv.rmse_after = 2.5;
  }
  const CaseScore result = score(hidden, diagnosis, 1.5);
  REQUIRE(result.parameters.size() == 1);
  CHECK(result.parameters[0].covered);
  CHECK(result.parameters[0].error == Approx(0.1));
  CHECK(result.onset_error == Approx(3.0));
  CHECK(result.rmse_before == Approx(3.0));
  CHECK(result.rmse_after == Approx(1.25));
  CHECK(std::isnan(score(hidden, mismatch({}), 1.0).rmse_after));
}

TEST_CASE("tables count what was named") {
  const HiddenCase hidden = blank_case(EffectClass::kGain, {effect(causes::gain(), 0, 1)});
  const std::vector<CaseScore> scores = {
      score(hidden, mismatch({finding(causes::gain(), 0, 1)}), 1.0),
      score(hidden, mismatch({finding(causes::noise(), 0, -1)}), 3.0),
      score(hidden, mismatch({}), 2.0)};
  CHECK(confusion_table(scores) ==
        "| hidden | unnamed | gain | noise |\n"
        "|--------|--------:|-----:|------:|\n"
        "| gain   |       1 |    1 |     1 |\n");
  const std::string classes = class_table(scores);
  CHECK(classes.find("1 of 3") != std::string::npos);
  CHECK(classes.find("2.00") != std::string::npos);
  CHECK(parameter_table(scores).empty());
}

}  // namespace mpm::hidden
