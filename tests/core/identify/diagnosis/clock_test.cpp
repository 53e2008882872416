#include "core/identify/diagnosis/clock.hpp"

#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::VectorXd;

// Rows of 1 s; the second run begins at row 100, 1000 s later than the rows say.
TEST_CASE("moments behind a border are told on the clock of the data") {
  Recording recording = test::recording_of(VectorXd::Zero(200), VectorXd::Zero(200));
  recording.borders = {{100, 1000.0}};
  const ModelSpec given = test::model_of({test::lag(0, 0, 2.0, 10.0)}, 1, 1);
  Diagnosis diagnosis;
  diagnosis.extended = given;
  DisturbanceTerm term;
  term.onset_s = 150.0;
  diagnosis.extended.disturbances.push_back(term);
  for (const double onset_s : {50.0, 150.0}) {
    Finding& finding = diagnosis.findings.emplace_back();
    finding.subject = {&causes::step_disturbance(), {0}};
    finding.onset_s = onset_s;
  }
  diagnosis.findings.emplace_back();  // one without an onset
  tell_on_clock(recording, given, diagnosis);
  CHECK(*diagnosis.findings[0].onset_s == 50.0);
  CHECK(*diagnosis.findings[1].onset_s == 1150.0);
  CHECK_FALSE(diagnosis.findings[2].onset_s);
  CHECK(diagnosis.extended.disturbances[0].onset_s == 1150.0);
}

TEST_CASE("with one run nothing is moved") {
  const Recording recording = test::recording_of(VectorXd::Zero(200), VectorXd::Zero(200));
  const ModelSpec given = test::model_of({test::lag(0, 0, 2.0, 10.0)}, 1, 1);
  Diagnosis diagnosis;
  diagnosis.extended = given;
  diagnosis.findings.emplace_back().onset_s = 150.0;
  tell_on_clock(recording, given, diagnosis);
  CHECK(*diagnosis.findings[0].onset_s == 150.0);
}

}  // namespace
}  // namespace mpm
