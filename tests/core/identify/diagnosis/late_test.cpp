#include "core/identify/diagnosis/late.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::late_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 900, kFitted = 600, kOnset = 700;

std::vector<Finding> late_in(const VectorXd& added, std::uint64_t seed) {
  const VectorXd u = test::telegraph(seed, kRows, 12);
  const VectorXd noise = 0.1 * test::autoregressive(test::normal(seed + 100, kRows), 0.5);
  const Recording recording =
      test::recording_of(u, test::first_order(u, 2.0, 10.0) + noise + added);
  const ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  return find_late(model, 1, recording, kFitted, {}).findings;
}

VectorXd step_at(Index row) {
  VectorXd step = VectorXd::Zero(kRows);
  step.tail(kRows - row).setConstant(0.8);
  return step;
}

TEST_CASE("a step in the rows kept for validation is named, and no repair is claimed") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    const std::vector<Finding> late = late_in(step_at(kOnset), seed);
    REQUIRE_FALSE(late.empty());
    CHECK(late[0].subject == Subject{&causes::step_disturbance(), {0}});
    CHECK(late[0].parameters[0].value == Approx(0.8).margin(0.1));
    REQUIRE(late[0].onset_s);
    CHECK(*late[0].onset_s == Approx(double{kOnset}).margin(3.0));
    CHECK_FALSE(late[0].repaired);
    CHECK_FALSE(late[0].refused.empty());
  }
}

// In noise of s.d. 0.12, with a time constant of 60 s. No rows are left that could bear it out.
TEST_CASE(
    "what comes late and passes is named where it stands out, and not where it hardly shows") {
  const auto passing = [](double size) {
    VectorXd added = VectorXd::Zero(kRows);
    for (Index k = kOnset; k < kRows; ++k)
      added(k) = size * std::exp(-static_cast<double>(k - kOnset) / 60.0);
    return added;
  };
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    const std::vector<Finding> late = late_in(passing(1.5), seed);
    REQUIRE(late.size() == 1);
    CHECK(late[0].subject == Subject{&causes::step_disturbance(), {0}});
    CHECK(late[0].parameters.back().name() == "decay");
    CHECK(late_in(passing(0.25), seed).empty());
  }
}

TEST_CASE("what began before is not named again, and nothing where nothing begins") {
  for (std::uint64_t seed = 11; seed <= 15; ++seed) {
    CAPTURE(seed);
    CHECK(late_in(VectorXd::Zero(kRows), seed).empty());
    for (const Finding& finding : late_in(step_at(200), seed))
      CHECK(finding.onset_s.value_or(0.0) >= 0.95 * kFitted);
  }
}

constexpr Index kMany = 1800, kLate = 1260;

/// Diagnosed where the gain is `before` times the model's until row `change`, then `since` times.
Diagnosis diagnosed(double before, double since, Index change = kLate, double noise = 0.1) {
  const VectorXd u = test::telegraph(3, kMany, 12);
  const VectorXd response = test::first_order(u, 2.0, 10.0);
  VectorXd cv = before * response + noise * test::autoregressive(test::normal(4, kMany), 0.5);
  cv.tail(kMany - change) += (since - before) * response.tail(kMany - change);
  DiagnosisSettings settings;
  settings.mv_count = 1;
  return diagnose(test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1), test::recording_of(u, cv), nullptr,
                  settings);
}

// The monitor bears 5 % of a gain, and the rows from which on an effect counts as late hold some
// from before the change: over all of them 6 % are less, though with so little noise seen beyond
// doubt.
TEST_CASE("a channel that changes late by too little to matter is not named") {
  const Diagnosis diagnosis = diagnosed(1.0, 1.06, kLate, 0.01);
  for (const Finding& finding : diagnosis.findings)
    CHECK_FALSE(finding.subject.cause->acts_through_channels());
}

// Row 1215 is just behind the border of 1200: what comes after it is parted anew.
TEST_CASE("a channel that changes late is named, and repaired just behind the border alone") {
  for (const Index change : {kLate, Index{1215}}) {
    CAPTURE(change);
    const Diagnosis diagnosis = diagnosed(1.0, 1.6, change);
    REQUIRE_FALSE(diagnosis.findings.empty());
    const Finding& finding = diagnosis.findings.front();
    CHECK(finding.subject == Subject{&causes::gain(), {0, 0}});
    CHECK(finding.parameters[0].value == Approx(1.6).margin(0.1));
    REQUIRE(finding.onset_s);
    CHECK(*finding.onset_s == Approx(static_cast<double>(change)).margin(15.0));
    CHECK(finding.repaired == (change != kLate));
  }
}

// A lag that becomes longer half-way, under so much noise that the test of all rows does not see it
// and no cause is found: that of the last half does. And nothing of the kind where none did.
TEST_CASE("no match is said of a channel that the last half of the rows rejects") {
  const auto verdict = [](double lag_rows, double noise) {
    constexpr Index kSince = 1000;
    const VectorXd u = test::telegraph(3, kMany, 12);
    VectorXd cv = test::first_order(u, 2.0, 10.0);
    cv.tail(kMany - kSince) = test::first_order(u, 2.0, lag_rows).tail(kMany - kSince);
    cv += noise * test::autoregressive(test::normal(4, kMany), 0.5);
    DiagnosisSettings settings;
    settings.mv_count = 1;
    return diagnose(test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1), test::recording_of(u, cv),
                    nullptr, settings)
        .verdict;
  };
  CHECK(verdict(14.0, 0.5) == DiagnosisVerdict::kUndetermined);
  CHECK(verdict(16.0, 0.7) == DiagnosisVerdict::kUndetermined);
  CHECK(verdict(10.0, 0.5) == DiagnosisVerdict::kMatch);
  CHECK(verdict(10.0, 0.7) == DiagnosisVerdict::kMatch);
}

TEST_CASE("a channel that was wrong before has nothing late of its own") {
  for (const Finding& finding : diagnosed(1.6, 1.6).findings) CHECK_FALSE(finding.onset_s);
}

// Two CVs with an input each; a gain of the first was refused, and a step of the other.
TEST_CASE("what is accused late may be what was refused of the same CV's channels") {
  const ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0), lag(1, 1, 2.0, 10.0)}, 2, 2);
  const auto effect = [](const Cause& cause, Place place) {
    Effect of;
    of.edit = &cause;
    of.place = place;
    return of;
  };
  const std::vector<Effect> refused = {effect(causes::gain(), {0, 0}),
                                       effect(causes::step_disturbance(), {1})};
  const auto asked = [&](const Cause& cause, Place place) {
    Finding late;
    late.subject = {&cause, place};
    return may_be_refused(late, refused, model);
  };
  CHECK(asked(causes::gain(), {0, 0}));
  CHECK(asked(causes::output_scale(), {0}));
  CHECK(asked(causes::input_scale(), {-1, 0}));
  CHECK_FALSE(asked(causes::gain(), {1, 1}));
  CHECK_FALSE(asked(causes::input_scale(), {-1, 1}));
  CHECK_FALSE(asked(causes::step_disturbance(), {0}));
}

}  // namespace
}  // namespace mpm::late_test
