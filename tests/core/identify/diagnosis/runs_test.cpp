#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"
#include "tests/core/identify/small_plant.hpp"

/// Diagnoses of several runs, whose levels and first states are their own.
namespace mpm::runs_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::lag;

ModelSpec model() { return test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1); }

/// A plant whose gain is `ratio` times the model's, at this level, from a state this far off.
struct Occasion {
  std::uint64_t seed;
  Index rows;
  double level, first_state, start_s;
};

Recording run(const Occasion& at, double ratio) {
  // Of more than two levels: at a level of its own, half a stroke of a two-level input would do.
  const VectorXd u =
      test::telegraph(at.seed, at.rows, 12) + 0.5 * test::telegraph(at.seed + 50, at.rows, 17);
  const VectorXd decay = VectorXd::NullaryExpr(
      at.rows, [](Index k) { return std::exp(-static_cast<double>(k) / 10.0); });
  const VectorXd noise = 0.1 * test::autoregressive(test::normal(at.seed + 100, at.rows), 0.5);
  Recording recording = test::recording_of(
      u, (ratio * test::first_order(u, 2.0, 10.0) + at.first_state * decay + noise).array() +
             at.level);
  recording.start_s = at.start_s;
  return recording;
}

Recording runs(const std::vector<Occasion>& occasions, double ratio) {
  std::vector<Recording> all;
  for (const Occasion& at : occasions) all.push_back(run(at, ratio));
  return joined(all);
}

const std::vector<Occasion> kTwo = {{11, 650, 3.0, 2.0, 0.0}, {12, 550, -2.0, -1.5, 9000.0}};
const std::vector<Occasion> kThree = {
    {3, 400, 1.0, 2.0, 0.0}, {4, 400, -4.0, 0.0, 9000.0}, {5, 400, 2.5, -3.0, 20000.0}};

Diagnosis diagnosis_of(const Recording& recording) {
  DiagnosisSettings settings;
  settings.mv_count = 1;
  return diagnose(model(), recording, nullptr, settings);
}

void check_gain(const Diagnosis& diagnosis, double ratio) {
  CHECK(diagnosis.verdict == DiagnosisVerdict::kMismatch);
  CHECK(diagnosis.refused.empty());
  CHECK(diagnosis.unexplained.empty());
  REQUIRE(diagnosis.findings.size() == 1);
  const Finding& finding = diagnosis.findings[0];
  CHECK(finding.subject == Subject{&causes::gain(), {0, 0}});
  CHECK(finding.repaired);
  REQUIRE(finding.parameters.size() == 1);
  CHECK(finding.parameters[0].low < ratio);
  CHECK(finding.parameters[0].high > ratio);
  CHECK(finding.parameters[0].high - finding.parameters[0].low < 0.1);
}

TEST_CASE("a gain is found in runs of different levels and first states") {
  for (const double ratio : {0.7, 1.4}) {
    const Diagnosis two = diagnosis_of(runs(kTwo, ratio));
    check_gain(two, ratio);
    CHECK(two.fit_samples == 800);  // two runs are cut as one would be
    // What is left is the noise: 0.1 / sqrt(1 - 0.25).
    CHECK(two.scores[0].rmse_after == Approx(0.1155).epsilon(0.25));
    const Diagnosis three = diagnosis_of(runs(kThree, ratio));
    check_gain(three, ratio);
    CHECK(three.fit_samples == 800);  // the last run is another occasion, of a level nobody knew
    CHECK(three.scores[0].rmse_after == Approx(0.1155).epsilon(0.25));
  }
}

TEST_CASE("a healthy plant matches whatever the levels of its runs") {
  for (const std::vector<Occasion>& occasions : {kTwo, kThree}) {
    const Diagnosis diagnosis = diagnosis_of(runs(occasions, 1.0));
    CHECK(diagnosis.verdict == DiagnosisVerdict::kMatch);
    CHECK(diagnosis.findings.empty());
    CHECK(diagnosis.refused.empty());
    CHECK(diagnosis.unexplained.empty());
    CHECK(diagnosis.after == diagnosis.before);
    CHECK(diagnosis.scores[0].rmse_before == Approx(0.1155).epsilon(0.25));
  }
}

TEST_CASE("what begins in a later run is told on its own clock") {
  // In the rows that are fitted: a second run longer than the first.
  Recording recording = joined({run(kTwo[0], 1.0), run({2, 1000, -2.0, 0.0, 9000.0}, 1.0)});
  recording.cvs.col(0).tail(800).array() += 2.0;  // from the 200th row of the second run on
  const Diagnosis diagnosis = diagnosis_of(recording);
  REQUIRE(diagnosis.findings.size() == 1);
  CHECK(diagnosis.findings[0].subject == Subject{&causes::step_disturbance(), {0}});
  REQUIRE(diagnosis.findings[0].onset_s);
  CHECK(*diagnosis.findings[0].onset_s == Approx(9200.0).margin(2.0));
}

}  // namespace
}  // namespace mpm::runs_test
