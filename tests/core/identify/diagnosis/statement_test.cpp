#include "core/identify/diagnosis/statement.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "tests/core/identify/proposals.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::statement_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 500;
/// s.d. that a 95 % interval reaches to either side, with a little for the noise model.
constexpr double kReach = 2.05;

/// Two CVs of one input, sampled every 2 s from 1000 s on, with hardly any noise.
struct Bench {
  ModelSpec model = two_cvs();
  Recording recording;
  Problem problem;

  Bench() : recording(plant()), problem(model, 1, recording, Tolerances{}, NoiseModel{}) {}

  static ModelSpec two_cvs() {
    ModelSpec two = test::model_of({lag(0, 0, 2.0, 20.0), lag(1, 0, 1.0, 10.0, 4.0)}, 1, 2);
    two.sample_time_s = 2.0;
    return two;
  }
  static Recording plant() {
    const VectorXd u = test::telegraph(1, kRows, 12);
    MatrixXd cvs(kRows, 2);
    cvs << test::first_order(u, 2.0, 10.0), test::first_order(u, 1.0, 5.0, 2);
    cvs.col(0) += 0.01 * test::white(2, kRows);
    cvs.col(1) += 0.01 * test::white(3, kRows);
    Recording measured = test::recording_of(u, cvs);
    measured.sample_time_s = 2.0;
    measured.start_s = 1000.0;
    return measured;
  }
};

/// Found, with these numbers and s.d.
SearchResult found_with(const Subject& subject, const std::vector<Coordinate>& coordinates,
                        const std::vector<double>& sd, Index onset = 0) {
  SearchResult found;
  Named named;
  named.effect = {subject.cause, subject.place, coordinates, onset};
  named.evidence = 42.0;
  named.confidence = 0.98;
  named.rivals = {{{&causes::dead_time(), {0, 0}}, 12.0, false}};
  found.named = {named};
  found.fit.effects = {named.effect};
  const auto count = static_cast<Index>(sd.size());
  found.fit.covariance = MatrixXd::Zero(count, count);
  for (Index i = 0; i < count; ++i)
    found.fit.covariance(i, i) = std::pow(sd[static_cast<std::size_t>(i)], 2);
  return found;
}

void check(const Parameter& parameter, const std::string& name, double value, double low,
           double high) {
  CHECK(parameter.name() == name);
  CHECK(parameter.value == Approx(value));
  CHECK(parameter.low == Approx(low));
  CHECK(parameter.high == Approx(high));
}

TEST_CASE("an interval goes no further than what its number may be") {
  const Quantity& lag = test::quantity_of(causes::step_disturbance(), "time_constant");
  const Coordinate coordinate{&lag, 5.0, 5.0, 10.0, 0.1, 0.01, 20.0};
  CHECK(stated(coordinate, 3.0, 1.0).low == 2.0);
  CHECK(stated(coordinate, 3.0, 1.0).high == 8.0);
  CHECK(stated(coordinate, 40.0, 1.0).low == 0.0);  // as if there were none
  CHECK(stated(coordinate, 40.0, 1.0).high == 20.0);
}

TEST_CASE("a finding's numbers are in the reports' terms, with their intervals") {
  const Bench bench;
  const SearchResult found = found_with(
      {&causes::dynamics(), {0, 0}},
      {{&kGainRatio, 1.3}, {&kTimeConstantRatio, 0.4}, {&kDeadTimeError, 1.5}}, {0.1, 0.05, 0.2});
  const Finding finding = to_finding(found, 0, bench.problem);
  REQUIRE(finding.parameters.size() == 3);
  check(finding.parameters[0], "gain_ratio", 1.3, 1.3 - 0.1 * kReach, 1.3 + 0.1 * kReach);
  check(finding.parameters[1], "time_constant_ratio", std::exp(0.4), std::exp(0.4 - 0.05 * kReach),
        std::exp(0.4 + 0.05 * kReach));
  check(finding.parameters[2], "dead_time_error", 3.0, 3.0 - 0.4 * kReach, 3.0 + 0.4 * kReach);
  CHECK(finding.subject == subject_of(found.named[0].effect));
  CHECK(finding.evidence == 42.0);
  CHECK(finding.confidence == 0.98);
  REQUIRE(finding.rivals.size() == 1);
  CHECK(finding.rivals[0].worse == 12.0);
  CHECK_FALSE(finding.onset_s);
}

TEST_CASE("the second finding has its own part of the covariance") {
  const Bench bench;
  SearchResult found = found_with({&causes::gain(), {0, 0}}, {{&kGainRatio, 1.3}}, {0.1});
  const SearchResult other = found_with({&causes::dynamics(), {1, 0}},
                                        {{&kGainRatio, 0.8}, {&kDeadTimeError, 1.0}}, {0, 0});
  found.named.push_back(other.named[0]);
  found.fit.effects.push_back(other.fit.effects[0]);
  found.fit.covariance = Eigen::Vector3d(0.01, 0.04, 0.09).asDiagonal();
  const Finding finding = to_finding(found, 1, bench.problem);
  REQUIRE(finding.parameters.size() == 2);
  CHECK(finding.parameters[0].high == Approx(0.8 + 0.2 * kReach));
  CHECK(finding.parameters[1].high == Approx(2.0 + 0.6 * kReach));
}

// Row 100 at 2 s a row after 1000 s.
TEST_CASE("what began inside the data says when") {
  const Bench bench;
  const Finding finding = to_finding(
      found_with({&causes::gain(), {0, 0}}, {{&kGainRatio, 1.3}}, {0.1}, 100), 0, bench.problem);
  REQUIRE(finding.onset_s);
  CHECK(*finding.onset_s == Approx(1200.0));
}

TEST_CASE("an input that the model leaves out has a dead time, not an error of one") {
  const Bench bench;
  const Cause& cause = causes::unmodelled_input();
  const Quantity &gain = test::quantity_of(cause, "gain"),
                 &time_constant = test::quantity_of(cause, "time_constant");
  const Finding finding = to_finding(
      found_with({&cause, {0, -1, 0}},
                 {{&gain, 0.5}, {&time_constant, std::log(30.0)}, {&kDeadTimeError, 2.0}},
                 {0.1, 0.1, 0.5}),
      0, bench.problem);
  REQUIRE(finding.parameters.size() == 3);
  CHECK(finding.parameters[1].name() == "time_constant");
  CHECK(finding.parameters[1].value == Approx(30.0));
  check(finding.parameters[2], "dead_time", 4.0, 4.0 - kReach, 4.0 + kReach);
}

// 3 sin + 4 cos is 5; 0.02 +- 0.001 kReach Hz is 50 s.
TEST_CASE("a sine is said by its size and its period") {
  const Bench bench;
  const Cause& cause = causes::periodic_disturbance();
  const Quantity &sine = test::quantity_of(cause, "sine"),
                 &cosine = test::quantity_of(cause, "cosine"),
                 &frequency = test::quantity_of(cause, "frequency");
  const Finding finding =
      to_finding(found_with({&cause, {0}}, {{&sine, 3.0}, {&cosine, 4.0}, {&frequency, 0.02}},
                            {0.1, 0.1, 1e-3}),
                 0, bench.problem);
  REQUIRE(finding.parameters.size() == 2);
  check(finding.parameters[0], "size", 5.0, 5.0 - 0.1 * kReach, 5.0 + 0.1 * kReach);
  check(finding.parameters[1], "period", 50.0, 1.0 / (0.02 + 1e-3 * kReach),
        1.0 / (0.02 - 1e-3 * kReach));
}

TEST_CASE("a square wave is said by a size above 0 and its period") {
  const Bench bench;
  const Cause& cause = causes::periodic_disturbance();
  const Quantity &begin = test::quantity_of(cause, "begin"),
                 &period = test::quantity_of(cause, "period");
  const Finding finding = to_finding(
      found_with({&cause, {0}}, {{&kSize, -0.4}, {&begin, 12.0}, {&period, 90.0}}, {0.1, 1.0, 0.5}),
      0, bench.problem);
  REQUIRE(finding.parameters.size() == 2);
  check(finding.parameters[0], "size", 0.4, 0.4 - 0.1 * kReach, 0.4 + 0.1 * kReach);
  check(finding.parameters[1], "period", 90.0, 90.0 - 0.5 * kReach, 90.0 + 0.5 * kReach);
}

// From row 100 of 500 on, 400 rows of 2 s at 0.01 a second: 8 by the end.
TEST_CASE("a drift is said by its rate and by what it comes to") {
  const Bench bench;
  const Cause& cause = causes::drift_disturbance();
  const Quantity& rate = test::quantity_of(cause, "rate");
  const Finding finding =
      to_finding(found_with({&cause, {0}}, {{&rate, 0.01}}, {0.001}, 100), 0, bench.problem);
  REQUIRE(finding.parameters.size() == 2);
  check(finding.parameters[0], "size", 8.0, 8.0 - 0.8 * kReach, 8.0 + 0.8 * kReach);
  check(finding.parameters[1], "rate", 0.01, 0.01 - 0.001 * kReach, 0.01 + 0.001 * kReach);
  REQUIRE(finding.onset_s);
  CHECK(*finding.onset_s == Approx(1200.0));
  const Finding always =
      to_finding(found_with({&cause, {0}}, {{&rate, 0.01}}, {0.001}), 0, bench.problem);
  CHECK(always.onset_s == Approx(1000.0));
}

}  // namespace
}  // namespace mpm::statement_test
