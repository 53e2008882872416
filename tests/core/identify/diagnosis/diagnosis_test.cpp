#include "core/identify/diagnosis/diagnosis.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/search/search.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 900;

ModelSpec model() { return test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1); }

VectorXd noise() { return 0.1 * test::autoregressive(test::white(2, kRows), 0.5); }

Recording plant(double gain_ratio, const VectorXd& added = VectorXd::Zero(kRows)) {
  const VectorXd u = test::telegraph(1, kRows, 12);
  return test::recording_of(u, gain_ratio * test::first_order(u, 2.0, 10.0) + noise() + added);
}

Diagnosis diagnosis_of(const Recording& recording, DiagnosisSettings settings = {}) {
  settings.mv_count = 1;
  return diagnose(model(), recording, nullptr, settings);
}

TEST_CASE("a model that is right matches") {
  const Diagnosis diagnosis = diagnosis_of(plant(1.0));
  CHECK(diagnosis.verdict == DiagnosisVerdict::kMatch);
  CHECK(diagnosis.findings.empty());
  CHECK(diagnosis.refused.empty());
  CHECK(diagnosis.unexplained.empty());
  CHECK(diagnosis.samples == 900);
  CHECK(diagnosis.fit_samples == 600);
  CHECK(diagnosis.validation_samples == 300);
  CHECK(diagnosis.after == diagnosis.before);
  REQUIRE(diagnosis.channels.size() == 1);
  // Within three s.d., of which the interval has 1.96 to either side.
  const ChannelEstimate& channel = diagnosis.channels[0];
  for (const Parameter& ratio : {channel.gain_ratio, channel.time_constant_ratio})
    CHECK(std::abs(ratio.value - 1.0) < 3.0 / (2.0 * 1.96) * (ratio.high - ratio.low));
  CHECK(channel.gain_ratio.high - channel.gain_ratio.low < 0.2);
}

TEST_CASE("a hidden gain is named, measured and repaired") {
  const Diagnosis diagnosis = diagnosis_of(plant(1.4));
  CHECK(diagnosis.verdict == DiagnosisVerdict::kMismatch);
  REQUIRE(diagnosis.findings.size() == 1);
  const Finding& finding = diagnosis.findings[0];
  CHECK(finding.subject == Subject{Cause::kGain, 0, 0, -1, ""});
  CHECK(finding.confidence > 0.9);
  REQUIRE(finding.parameters.size() == 1);
  CHECK(finding.parameters[0].low < 1.4);
  CHECK(finding.parameters[0].high > 1.4);
  CHECK(finding.parameters[0].value == Approx(1.4).margin(0.04));
  // 0.1 / sqrt(1 - 0.25), known to some 7 % over 300 rows that hang together.
  CHECK(diagnosis.scores[0].rmse_after == Approx(0.1155).epsilon(0.25));
  CHECK(diagnosis.scores[0].gain_low > 0.0);
  CHECK(diagnosis.channels[0].gain_ratio.value == Approx(1.4).margin(0.05));
}

TEST_CASE("a sensor that clips is read from its plateau") {
  Recording recording = plant(1.0);
  recording.cvs = recording.cvs.cwiseMin(1.4);
  const Diagnosis diagnosis = diagnosis_of(recording);
  REQUIRE(diagnosis.findings.size() == 1);
  CHECK(diagnosis.findings[0].subject ==
        Subject{Cause::kOutputNonlinearity, 0, -1, -1, "saturation"});
  REQUIRE(diagnosis.findings[0].parameters.size() == 1);
  CHECK(diagnosis.findings[0].parameters[0].name == "high");
  CHECK(diagnosis.findings[0].parameters[0].value == Approx(1.4).epsilon(1e-4));
}

TEST_CASE("noise that becomes four times as strong is a finding without a repair") {
  Recording recording = plant(1.0);
  VectorXd louder = noise();
  recording.cvs.col(0).segment(300, 600) += louder.segment(300, 600);
  const Diagnosis diagnosis = diagnosis_of(recording);
  REQUIRE(diagnosis.findings.size() == 1);
  CHECK(diagnosis.findings[0].subject == Subject{Cause::kNoise, 0, -1, -1, ""});
  CHECK(diagnosis.findings[0].parameters[0].low < 4.0);
  CHECK(diagnosis.findings[0].parameters[0].high > 4.0);
  REQUIRE(diagnosis.findings[0].onset_s);
  CHECK(*diagnosis.findings[0].onset_s == Approx(300.0).margin(40.0));
  CHECK(diagnosis.after == diagnosis.before);
}

TEST_CASE("inputs that hardly move decide nothing") {
  const VectorXd u = 0.005 * test::telegraph(1, kRows, 12);
  const Diagnosis diagnosis = diagnosis_of(
      test::recording_of(u, test::first_order(u, 2.0, 10.0) + 0.5 * test::white(2, kRows)));
  CHECK(diagnosis.verdict == DiagnosisVerdict::kUndetermined);
  CHECK(diagnosis.reason.find("move too little") != std::string::npos);
}

TEST_CASE("a diagnosis that is stopped says so, and the model is as it was") {
  DiagnosisSettings settings;
  double last = 0.0;
  bool rises = true;
  settings.progress = [&](double share) {
    rises = rises && share >= last;
    last = share;
    return share < 0.3;
  };
  const Diagnosis diagnosis = diagnosis_of(plant(1.4), settings);
  CHECK(diagnosis.verdict == DiagnosisVerdict::kUndetermined);
  CHECK(diagnosis.reason == "stopped");
  CHECK(diagnosis.findings.empty());
  CHECK(diagnosis.extended.channels.size() == 1);
  CHECK(last >= 0.3);
  CHECK(rises);
}

TEST_CASE("the same data are diagnosed to the same bits") {
  const Recording recording = plant(1.4);
  const Diagnosis first = diagnosis_of(recording), second = diagnosis_of(recording);
  REQUIRE(first.findings.size() == 1);
  REQUIRE(second.findings.size() == 1);
  CHECK(first.after == second.after);
  CHECK(first.findings[0].evidence == second.findings[0].evidence);
  CHECK(first.scores[0].gain_low == second.scores[0].gain_low);
}

// By hand: five rows for each of 3 numbers a channel, 8 of the noise and 4 others, in two thirds.
TEST_CASE("a model with more channels needs more rows") {
  CHECK(needed_samples(model()) == 15 * (3 + 8 + 4) / 2);
  ModelSpec three =
      test::model_of({lag(0, 0, 1.0, 5.0), lag(0, 1, 1.0, 5.0), lag(1, 0, 1.0, 5.0)}, 2, 2);
  CHECK(needed_samples(three) == 15 * (6 + 8 + 4) / 2);
}

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
    if (named.effect.subject.cv == 0) {
      CHECK(named.effect.subject == Subject{Cause::kGain, 0, 0, -1, ""});
      CHECK(named.effect.value("gain_ratio", 1.0) == Approx(1.3).margin(0.03));
    } else {
      CHECK(named.effect.subject == Subject{Cause::kTimeConstant, 1, 1, -1, ""});
      CHECK(std::exp(named.effect.value("log_time_constant_ratio", 0.0)) ==
            Approx(2.0).margin(0.2));
    }
  }
  SearchSettings one;
  one.max_findings = 1;
  CHECK(search(problem, one).named.size() == 1);
}

}  // namespace
}  // namespace mpm
