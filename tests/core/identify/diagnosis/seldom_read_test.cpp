#include "core/identify/diagnosis/seldom_read.hpp"

#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::seldom_read_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 900;

// The first CV is an analyser's, the second one is measured at every sample.
ModelSpec model() { return test::model_of({lag(0, 0, 1.0, 20.0), lag(1, 0, 2.0, 10.0)}, 1, 2); }

Recording plant(double gain_ratio, Index every) {
  const VectorXd u = test::telegraph(1, kRows, 12);
  MatrixXd cvs(kRows, 2);
  const auto noise = [](std::uint64_t stream) {
    return VectorXd(0.1 * test::autoregressive(test::white(stream, kRows), 0.5));
  };
  cvs.col(0) = test::first_order(u, 1.0, 20.0) + noise(3);
  cvs.col(1) = gain_ratio * test::first_order(u, 2.0, 10.0) + noise(2);
  for (Index k = 0; k < kRows; ++k) cvs(k, 0) = cvs(k - k % every, 0);
  return test::recording_of(u, cvs);
}

Diagnosis diagnosis_of(const Recording& recording) {
  DiagnosisSettings settings;
  settings.mv_count = 1;
  return diagnose(model(), recording, nullptr, settings);
}

TEST_CASE("what an analyser holds between two readings is no cause, and hides none") {
  const Diagnosis healthy = diagnosis_of(plant(1.0, 10));
  CHECK(healthy.verdict == DiagnosisVerdict::kUndetermined);  // nobody looked at the first CV
  CHECK(healthy.findings.empty());
  CHECK(healthy.reason.find("was not judged") != std::string::npos);

  const Diagnosis diagnosis = diagnosis_of(plant(1.4, 10));
  REQUIRE(diagnosis.findings.size() == 1);
  CHECK(diagnosis.findings[0].subject == Subject{&causes::gain(), {1, 0}});
  CHECK(diagnosis.findings[0].parameters[0].value == Approx(1.4).margin(0.04));
  REQUIRE(diagnosis.channels.size() == 1);
  CHECK(diagnosis.channels[0].cv == 1);
  REQUIRE(diagnosis.extended.channels.size() == 2);
  CHECK(std::get<TransferFunction>(diagnosis.extended.channels[0].dynamics).gain == 1.0);
  CHECK(std::get<TransferFunction>(diagnosis.extended.channels[1].dynamics).gain ==
        Approx(2.8).margin(0.08));
  REQUIRE(diagnosis.scores.size() == 2);
  CHECK_FALSE(diagnosis.scores[0].judged);
  CHECK(diagnosis.scores[0].rmse_before > 0.1);  // at least its noise
  CHECK(diagnosis.scores[1].judged);
  CHECK(diagnosis.scores[1].gain_low > 0.0);
  CHECK(diagnosis.before.cols() == 2);
  CHECK(diagnosis.after.col(0) == diagnosis.before.col(0));
}

TEST_CASE("where every CV is read only now and then the sample time is what is wrong") {
  Recording recording = plant(1.4, 10);
  for (Index k = 0; k < kRows; ++k) recording.cvs(k, 1) = recording.cvs(k - k % 10, 1);
  const Diagnosis diagnosis = diagnosis_of(recording);
  CHECK(diagnosis.verdict == DiagnosisVerdict::kUndetermined);
  CHECK(diagnosis.reason.find("sample_time") != std::string::npos);
}

TEST_CASE("a part of a model stands in the whole where it was") {
  ModelSpec whole = model();
  whole.output_origin << 5.0, 7.0;
  whole.disturbances = {{0, DisturbanceShape::kStep, 1.0, 2.0},
                        {1, DisturbanceShape::kStep, 3.0, 4.0}};
  const std::vector<int> second = {1};
  ModelSpec part = of_cvs(whole, second);
  CHECK(part.cv_count == 1);
  REQUIRE(part.channels.size() == 1);
  CHECK(part.channels[0].cv == 0);
  CHECK(part.output_origin(0) == 7.0);
  REQUIRE(part.disturbances.size() == 1);
  CHECK(part.disturbances[0].size == 4.0);
  part.output_origin(0) = 8.0;
  const ModelSpec again = within(whole, part, second);
  CHECK(again.cv_count == 2);
  REQUIRE(again.channels.size() == 2);
  CHECK(again.channels[1].cv == 1);
  CHECK(again.output_origin(0) == 5.0);
  CHECK(again.output_origin(1) == 8.0);
  REQUIRE(again.disturbances.size() == 2);
  CHECK(again.disturbances[1].cv == 1);
}

}  // namespace
}  // namespace mpm::seldom_read_test
