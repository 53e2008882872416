#include "core/identify/diagnosis/extension.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
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

  explicit Bench(double gain_ratio = 1.0)
      : recording(plant(gain_ratio)), problem(model, 1, recording, Tolerances{}, NoiseModel{}) {}

  static ModelSpec two_cvs() {
    ModelSpec two = test::model_of({lag(0, 0, 2.0, 20.0), lag(1, 0, 1.0, 10.0, 4.0)}, 1, 2);
    two.sample_time_s = 2.0;
    return two;
  }
  static Recording plant(double gain_ratio) {
    const VectorXd u = test::telegraph(1, kRows, 12);
    MatrixXd cvs(kRows, 2);
    cvs << gain_ratio * test::first_order(u, 2.0, 10.0), test::first_order(u, 1.0, 5.0, 2);
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
  named.effect.subject = subject;
  named.effect.coordinates = coordinates;
  named.effect.onset = onset;
  named.evidence = 42.0;
  named.confidence = 0.98;
  named.rivals = {{{Cause::kDeadTime, 0, 0, -1, ""}, 12.0, false}};
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
  CHECK(parameter.name == name);
  CHECK(parameter.value == Approx(value));
  CHECK(parameter.low == Approx(low));
  CHECK(parameter.high == Approx(high));
}

TEST_CASE("a finding's numbers are in the reports' terms, with their intervals") {
  const Bench bench;
  const SearchResult found = found_with(
      {Cause::kDynamics, 0, 0, -1, ""},
      {{"gain_ratio", 1.3}, {"log_time_constant_ratio", 0.4}, {"dead_time_samples", 1.5}},
      {0.1, 0.05, 0.2});
  const Finding finding = to_finding(found, 0, bench.problem);
  REQUIRE(finding.parameters.size() == 3);
  check(finding.parameters[0], "gain_ratio", 1.3, 1.3 - 0.1 * kReach, 1.3 + 0.1 * kReach);
  check(finding.parameters[1], "time_constant_ratio", std::exp(0.4), std::exp(0.4 - 0.05 * kReach),
        std::exp(0.4 + 0.05 * kReach));
  check(finding.parameters[2], "dead_time_error", 3.0, 3.0 - 0.4 * kReach, 3.0 + 0.4 * kReach);
  CHECK(finding.subject == found.named[0].effect.subject);
  CHECK(finding.evidence == 42.0);
  CHECK(finding.confidence == 0.98);
  REQUIRE(finding.rivals.size() == 1);
  CHECK(finding.rivals[0].worse == 12.0);
  CHECK_FALSE(finding.onset_s);
}

TEST_CASE("the second finding has its own part of the covariance") {
  const Bench bench;
  SearchResult found = found_with({Cause::kGain, 0, 0, -1, ""}, {{"gain_ratio", 1.3}}, {0.1});
  const SearchResult other = found_with({Cause::kDynamics, 1, 0, -1, ""},
                                        {{"gain_ratio", 0.8}, {"dead_time_samples", 1.0}}, {0, 0});
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
  const Finding finding =
      to_finding(found_with({Cause::kGain, 0, 0, -1, ""}, {{"gain_ratio", 1.3}}, {0.1}, 100), 0,
                 bench.problem);
  REQUIRE(finding.onset_s);
  CHECK(*finding.onset_s == Approx(1200.0));
}

TEST_CASE("an input that the model leaves out has a dead time, not an error of one") {
  const Bench bench;
  const Finding finding = to_finding(
      found_with({Cause::kUnmodelledInput, 0, -1, 0, ""},
                 {{"gain", 0.5}, {"log_time_constant", std::log(30.0)}, {"dead_time_samples", 2.0}},
                 {0.1, 0.1, 0.5}),
      0, bench.problem);
  REQUIRE(finding.parameters.size() == 3);
  CHECK(finding.parameters[1].name == "time_constant");
  CHECK(finding.parameters[1].value == Approx(30.0));
  check(finding.parameters[2], "dead_time", 4.0, 4.0 - kReach, 4.0 + kReach);
}

// 3 sin + 4 cos is 5; 0.02 +- 0.001 kReach Hz is 50 s.
TEST_CASE("a sine is said by its size and its period") {
  const Bench bench;
  const Finding finding = to_finding(
      found_with({Cause::kOutputDisturbance, 0, -1, -1, "periodic"},
                 {{"sine", 3.0}, {"cosine", 4.0}, {"frequency", 0.02}}, {0.1, 0.1, 1e-3}),
      0, bench.problem);
  REQUIRE(finding.parameters.size() == 2);
  check(finding.parameters[0], "size", 5.0, 5.0 - 0.1 * kReach, 5.0 + 0.1 * kReach);
  check(finding.parameters[1], "period", 50.0, 1.0 / (0.02 + 1e-3 * kReach),
        1.0 / (0.02 - 1e-3 * kReach));
}

TEST_CASE("a square wave is said by a size above 0 and its period") {
  const Bench bench;
  const Finding finding =
      to_finding(found_with({Cause::kOutputDisturbance, 0, -1, -1, "periodic"},
                            {{"size", -0.4}, {"begin", 12.0}, {"period", 90.0}}, {0.1, 1.0, 0.5}),
                 0, bench.problem);
  REQUIRE(finding.parameters.size() == 2);
  check(finding.parameters[0], "size", 0.4, 0.4 - 0.1 * kReach, 0.4 + 0.1 * kReach);
  check(finding.parameters[1], "period", 90.0, 90.0 - 0.5 * kReach, 90.0 + 0.5 * kReach);
}

// From row 100 of 500 on, 400 rows of 2 s at 0.01 a second: 8 by the end.
TEST_CASE("a drift is said by its rate and by what it comes to") {
  const Bench bench;
  const Finding finding = to_finding(
      found_with({Cause::kOutputDisturbance, 0, -1, -1, "drift"}, {{"rate", 0.01}}, {0.001}, 100),
      0, bench.problem);
  REQUIRE(finding.parameters.size() == 2);
  check(finding.parameters[0], "size", 8.0, 8.0 - 0.8 * kReach, 8.0 + 0.8 * kReach);
  check(finding.parameters[1], "rate", 0.01, 0.01 - 0.001 * kReach, 0.01 + 0.001 * kReach);
  REQUIRE(finding.onset_s);
  CHECK(*finding.onset_s == Approx(1200.0));
  const Finding always = to_finding(
      found_with({Cause::kOutputDisturbance, 0, -1, -1, "drift"}, {{"rate", 0.01}}, {0.001}), 0,
      bench.problem);
  CHECK(always.onset_s == Approx(1000.0));
}

// The plant's gain is 1.3 times the model's: fitted and put into the model, it is the plant's.
TEST_CASE("the extended model is the plant") {
  Bench bench(1.3);
  SearchResult found = found_with({Cause::kGain, 0, 0, -1, ""},
                                  {{"gain_ratio", 1.0, 1.0, 0.25, 0.01, 0.02, 20.0}}, {0.0});
  found.fit = bench.problem.fit(found.fit.effects, 0, {0, 1}, 10);
  found.named[0].effect = found.fit.effects[0];
  const ModelSpec extended = extend(bench.problem, found, {true}, {true, true});
  const auto& first = std::get<TransferFunction>(extended.channels[0].dynamics);
  CHECK(first.gain == Approx(2.6).epsilon(0.002));
  CHECK(first.time_constants_s[0] == Approx(20.0).epsilon(0.005));
  CHECK(extended.output_origin(0) == Approx(0.0).margin(0.005));
  // Nothing was found on the second CV: it stays to the last bit.
  const auto& second = std::get<TransferFunction>(extended.channels[1].dynamics);
  CHECK(second.gain == 1.0);
  CHECK(second.time_constants_s[0] == 10.0);
  CHECK(second.dead_time_s == 4.0);
  CHECK(extended.output_origin(1) == 0.0);
}

// By hand: small errors of 1.5, -2 and 0.5 tolerances, and a level.
TEST_CASE("small errors and levels go into the model beside what was found") {
  const Bench bench;
  SearchResult found =
      found_with({Cause::kOutputDisturbance, 1, -1, -1, "step"}, {{"size", 0.7}}, {0.1}, 50);
  CvFit fit;
  fit.cv = 1;
  const CvData& data = bench.problem.data(1);
  fit.beta = VectorXd::Zero(data.nuisances.cols());
  fit.beta.head(4) << 0.25, 1.5, -2.0, 0.5;
  found.fit.cvs = {fit};
  const double level = 0.25 * data.nuisances(0, 0);
  const ModelSpec extended = extend(bench.problem, found, {true}, {true, true});
  const auto& channel = std::get<TransferFunction>(extended.channels[1].dynamics);
  CHECK(channel.gain == Approx(1.0 + 1.5 * 0.02));
  CHECK(channel.time_constants_s[0] == Approx(10.0 * std::exp(-2.0 * 0.03)));
  CHECK(channel.dead_time_s == Approx(4.0 + 0.5 * 0.1 * 2.0));
  CHECK(extended.output_origin(1) == Approx(level));
  REQUIRE(extended.disturbances.size() == 1);
  CHECK(extended.disturbances[0].size == 0.7);
  CHECK(extended.disturbances[0].onset_s == 1100.0);

  // A CV that is not to be kept has the effect alone; without the effect there is nothing at all.
  const ModelSpec alone = extend(bench.problem, found, {true}, {true, false});
  CHECK(std::get<TransferFunction>(alone.channels[1].dynamics).gain == 1.0);
  CHECK(alone.output_origin(1) == 0.0);
  CHECK(alone.disturbances.size() == 1);
  const ModelSpec nothing = extend(bench.problem, found, {false}, {true, true});
  CHECK(nothing.disturbances.empty());
  CHECK(std::get<TransferFunction>(nothing.channels[1].dynamics).gain == 1.0);
}

// Of two aux signals the second is used: it becomes the input after the model's.
TEST_CASE("aux signals that no channel uses are no inputs of the finished model") {
  const ModelSpec base = Bench::two_cvs();
  Recording recording = Bench().recording;
  recording.aux = MatrixXd::Constant(kRows, 2, 3.0);
  recording.aux.col(1).setConstant(7.0);
  ModelSpec extended = with_aux_inputs(base, recording);
  extended.input_blocks[0] = Deadband{0.1};
  extended.channels.push_back(lag(1, 2, 0.5, 30.0));
  std::vector<int> used = {9};
  const ModelSpec model = finish(extended, base, used);
  CHECK(used == std::vector<int>{1});
  CHECK(model.input_count == 2);
  CHECK(model.input_blocks.size() == 2);
  CHECK(model.input_blocks[0].has_value());
  REQUIRE(model.channels.size() == 3);
  CHECK(model.channels[2].input == 1);
  CHECK(model.input_origin(1) == 7.0);
  const ModelSpec without = finish(with_aux_inputs(base, recording), base, used);
  CHECK(used.empty());
  CHECK(without.input_count == 1);
}

}  // namespace
}  // namespace mpm
