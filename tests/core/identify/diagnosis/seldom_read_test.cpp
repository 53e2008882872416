#include "core/identify/diagnosis/seldom_read.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/fit/condense.hpp"
#include "core/identify/fit/free_run.hpp"
#include "core/identify/fit/simulator.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::seldom_read_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 900, kMany = 6000;

// The first CV is an analyser's, the second one is measured at every sample.
ModelSpec model() { return test::model_of({lag(0, 0, 1.0, 20.0), lag(1, 0, 2.0, 10.0)}, 1, 2); }

void read_every(Index every, Index offset, Eigen::Ref<VectorXd> cv) {
  for (Index k = offset; k < cv.size(); ++k) cv(k) = cv(k - (k - offset) % every);
}

Recording plant(double gain_ratio, Index every, Index rows = kRows, double of_first = 1.0,
                std::uint64_t seed = 1) {
  const VectorXd u = test::telegraph(seed, rows, 12);
  MatrixXd cvs(rows, 2);
  const auto noise = [&](std::uint64_t stream) {
    return VectorXd(0.1 * test::autoregressive(test::white(seed + stream, rows), 0.5));
  };
  cvs.col(0) = of_first * test::first_order(u, 1.0, 20.0) + noise(2);
  cvs.col(1) = gain_ratio * test::first_order(u, 2.0, 10.0) + noise(1);
  read_every(every, 0, cvs.col(0));
  return test::recording_of(u, cvs);
}

Diagnosis diagnosis_of(const Recording& recording) {
  DiagnosisSettings settings;
  settings.mv_count = 1;
  return diagnose(model(), recording, nullptr, settings);
}

// 90 readings are too few to judge it by.
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

TEST_CASE("what is wrong in a CV that is read seldom is found at its readings, and repaired") {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CAPTURE(seed);
    const Diagnosis healthy = diagnosis_of(plant(1.0, 10, kMany, 1.0, 10 * seed));
    CHECK(healthy.verdict == DiagnosisVerdict::kMatch);
    CHECK(healthy.findings.empty());
    CHECK(healthy.scores[0].judged);

    const Recording recording = plant(1.4, 10, kMany, 1.5, 10 * seed);
    const Diagnosis diagnosis = diagnosis_of(recording);
    CHECK(diagnosis.verdict == DiagnosisVerdict::kMismatch);
    REQUIRE(diagnosis.findings.size() == 2);
    for (const Finding& finding : diagnosis.findings) {
      const int cv = finding.subject.place.cv;
      CHECK(finding.subject == Subject{&causes::gain(), {cv, 0}});
      CHECK(finding.parameters[0].value == Approx(cv == 0 ? 1.5 : 1.4).margin(0.1));
    }
    CHECK(diagnosis.findings[0].subject.place.cv != diagnosis.findings[1].subject.place.cv);
    CHECK(diagnosis.samples == kMany);
    CHECK(diagnosis.extended.sample_time_s == 1.0);
    REQUIRE(diagnosis.extended.channels.size() == 2);
    for (const ChannelSpec& channel : diagnosis.extended.channels)
      CHECK(std::get<TransferFunction>(channel.dynamics).gain ==
            Approx(channel.cv == 0 ? 1.5 : 2.8).epsilon(0.05));
    REQUIRE(diagnosis.scores.size() == 2);
    CHECK(diagnosis.scores[0].judged);
    CHECK(diagnosis.scores[0].gain_low > 0.0);
    // On the rows of the recording, as what is measured at every sample.
    REQUIRE(diagnosis.after.rows() == kMany);
    const VectorXd truth = 1.5 * test::first_order(recording.inputs.col(0), 1.0, 20.0);
    CHECK((diagnosis.after.col(0) - truth).norm() < 0.2 * (diagnosis.before.col(0) - truth).norm());
  }
}

// The mean of an input of two levels is anywhere between them, where it moved between readings: a
// wrong gain must not be taken for a curve.
TEST_CASE("where every CV is read in a cycle each is judged in its own") {
  Recording recording = plant(1.4, 10, kMany);
  read_every(6, 2, recording.cvs.col(1));
  const std::vector<Readings> readings = readings_of(recording);
  REQUIRE(readings.size() == 3);
  CHECK(readings[0].cvs.empty());
  CHECK(readings[1].every == 10);
  CHECK(readings[1].offsets == std::vector{0.0});
  CHECK(readings[1].cvs == std::vector<int>{0});
  CHECK(readings[2].every == 6);
  CHECK(readings[2].offsets == std::vector{2.0});
  const Diagnosis diagnosis = diagnosis_of(recording);
  REQUIRE(diagnosis.findings.size() == 1);
  CHECK(diagnosis.findings[0].subject == Subject{&causes::gain(), {1, 0}});
  CHECK(diagnosis.findings[0].parameters[0].value == Approx(1.4).margin(0.1));
}

// A DMC model's step coefficients, and a filter: closed form of the first CV's lag, sampled.
TEST_CASE("a channel in samples is judged at readings, and repaired at its own sample time") {
  const bool coefficients = GENERATE(true, false);
  const double ratio = GENERATE(1.0, 1.5);
  CAPTURE(coefficients, ratio);
  const double pole = std::exp(-1.0 / 20.0);
  ModelSpec sampled = model();
  if (coefficients) {
    StepResponse step;
    for (int k = 0; k <= 150; ++k) step.values.push_back(1.0 - std::pow(pole, k));
    sampled.channels[0].dynamics = step;
  } else {
    sampled.channels[0].dynamics = DiscreteFilter{{1.0 - pole}, {1.0, -pole}, 0};
  }
  const Recording recording = plant(1.0, 10, kMany, ratio);
  DiagnosisSettings settings;
  settings.mv_count = 1;
  const Diagnosis diagnosis = diagnose(sampled, recording, nullptr, settings);
  REQUIRE(diagnosis.scores.size() == 2);
  CHECK(diagnosis.scores[0].judged);
  REQUIRE(diagnosis.findings.size() == (ratio > 1.0 ? 1 : 0));
  if (ratio == 1.0) {
    CHECK(diagnosis.verdict == DiagnosisVerdict::kMatch);
    return;
  }
  CHECK(diagnosis.findings[0].subject == Subject{&causes::gain(), {0, 0}});
  CHECK(diagnosis.findings[0].parameters[0].value == Approx(1.5).margin(0.1));
  CHECK(diagnosis.extended.sample_time_s == 1.0);
  REQUIRE(diagnosis.extended.channels.size() == 2);
  const auto& dynamics = diagnosis.extended.channels[0].dynamics;
  CHECK(std::holds_alternative<StepResponse>(dynamics) == coefficients);
  if (coefficients) {
    CHECK(std::get<StepResponse>(dynamics).values.size() == Approx(151).margin(10));
    CHECK(std::get<StepResponse>(dynamics).values.back() == Approx(1.5).margin(0.1));
  } else {
    CHECK(std::get<DiscreteFilter>(dynamics).denominator[1] == Approx(-pole).epsilon(0.01));
  }
  const VectorXd truth = ratio * test::first_order(recording.inputs.col(0), 1.0, 20.0);
  CHECK((diagnosis.after.col(0) - truth).norm() < 0.2 * (diagnosis.before.col(0) - truth).norm());
}

// A mean of what fills a tank is not what its level answers.
TEST_CASE("tanks are not judged at readings") {
  ModelSpec tank = model();
  tank.channels[0].dynamics = TankChain{{20.0}, -4.0, -2.0, {}, 0.0, 0.0};
  DiagnosisSettings settings;
  settings.mv_count = 1;
  const Diagnosis diagnosis = diagnose(tank, plant(1.0, 10, kMany), nullptr, settings);
  REQUIRE(diagnosis.scores.size() == 2);
  CHECK_FALSE(diagnosis.scores[0].judged);
  CHECK(diagnosis.scores[1].judged);
  CHECK(diagnosis.reason.find("was not judged") != std::string::npos);
}

TEST_CASE("a state space of which a CV is read seldom is judged, and is one again") {
  ModelSpec states = model();
  states.channels.clear();
  StateSpaceSpec space;
  const double first = std::exp(-1.0 / 20.0), second = std::exp(-1.0 / 10.0);
  space.a = Eigen::Matrix2d{{first, 0.0}, {0.0, second}};
  space.b = Eigen::Vector2d{1.0 - first, 2.0 * (1.0 - second)};
  space.c = Eigen::Matrix2d::Identity();
  space.d = Eigen::Vector2d::Zero();
  states.state_space = space;
  DiagnosisSettings settings;
  settings.mv_count = 1;
  const Diagnosis diagnosis = diagnose(states, plant(1.0, 10, kMany, 1.5), nullptr, settings);
  REQUIRE(diagnosis.findings.size() == 1);
  CHECK(diagnosis.findings[0].subject == Subject{&causes::gain(), {0, 0}});
  REQUIRE(diagnosis.extended.state_space);
  const StateSpaceSpec& repaired = *diagnosis.extended.state_space;
  const VectorXd gain =
      repaired.c * (MatrixXd::Identity(repaired.a.rows(), repaired.a.cols()) - repaired.a)
                       .lu()
                       .solve(repaired.b) +
      repaired.d;
  CHECK(gain(0) == Approx(1.5).margin(0.1));
  CHECK(gain(1) == Approx(2.0).margin(1e-6));
}

TEST_CASE("a CV that is read every 10.3 rows is judged, and its gain found") {
  const double ratio = GENERATE(1.0, 1.4);
  Recording recording = plant(1.0, 1, kMany, ratio);
  VectorXd first = recording.cvs.col(0);
  for (Index k = 0, last = 0; k < kMany; ++k) {
    if (std::floor(static_cast<double>(k) / 10.3) > std::floor(static_cast<double>(k - 1) / 10.3))
      last = k;
    recording.cvs(k, 0) = first(last);
  }
  const std::vector<Readings> readings = readings_of(recording);
  REQUIRE(readings.size() == 2);
  CHECK(readings[1].every == Approx(10.3).epsilon(1e-4));
  const Diagnosis diagnosis = diagnosis_of(recording);
  REQUIRE(diagnosis.findings.size() == (ratio > 1.0 ? 1 : 0));
  if (ratio == 1.0) return;
  CHECK(diagnosis.findings[0].subject == Subject{&causes::gain(), {0, 0}});
  CHECK(diagnosis.findings[0].parameters[0].value == Approx(1.4).margin(0.1));
}

TEST_CASE("on a second recording a CV is read from where its cycle begins there") {
  const Recording recording = plant(1.0, 10, kMany, 1.5);
  Recording other = plant(1.0, 10, kMany, 1.5, 20);
  other = part(other, 3, kMany - 3);  // readings at 7, 17, ...
  const auto there = readings_in(other, readings_of(recording)[1]);
  REQUIRE(there);
  CHECK(there->offsets == std::vector{7.0});
  DiagnosisSettings settings;
  settings.mv_count = 1;
  const Diagnosis diagnosis = diagnose(model(), recording, &other, settings);
  REQUIRE(diagnosis.findings.size() == 1);
  CHECK(diagnosis.findings[0].subject == Subject{&causes::gain(), {0, 0}});
  CHECK(diagnosis.scores[0].gain_low > 0.0);
  CHECK(diagnosis.validation_samples == kMany - 3);
  CHECK(diagnosis.validation_after.rows() == kMany - 3);
}

TEST_CASE("a model that runs away is said to, however a CV is read") {
  ModelSpec runs_away = model();
  runs_away.state_terms = {{1, 0, RestoringForce{0.5, 0.0}}};
  DiagnosisSettings settings;
  settings.mv_count = 1;
  const Diagnosis diagnosis = diagnose(runs_away, plant(1.0, 10, kMany), nullptr, settings);
  CHECK(diagnosis.verdict == DiagnosisVerdict::kUndetermined);
  CHECK(diagnosis.reason.find("runs away") != std::string::npos);
}

TEST_CASE("an actuator that all CVs see is said once") {
  constexpr Index kOnset = 3000;
  const VectorXd u = test::telegraph(7, kMany, 12);
  VectorXd acts = u;
  acts.tail(kMany - kOnset).setConstant(u(kOnset));
  MatrixXd cvs(kMany, 2);
  cvs.col(0) = test::first_order(acts, 1.0, 20.0) + 0.1 * test::white(8, kMany);
  cvs.col(1) = test::first_order(acts, 2.0, 10.0) + 0.1 * test::white(9, kMany);
  read_every(10, 0, cvs.col(0));
  const Diagnosis diagnosis = diagnosis_of(test::recording_of(u, cvs));
  REQUIRE(diagnosis.findings.size() == 1);
  CHECK(diagnosis.findings[0].subject == Subject{&causes::input_stuck(), {-1, 0}});
  // What is drawn and scored is what the extended model says, of each CV.
  const Recording recording = test::recording_of(u, cvs);
  Simulator simulator(recording);
  CHECK((free_runs(simulator, diagnosis.extended) - diagnosis.after).lpNorm<Eigen::Infinity>() <
        1e-9);
}

TEST_CASE("what one part's CVs see of an actuator is not put before the others' channels") {
  Extended part{of_cvs(model(), {1})};
  part.model.input_blocks[0] = Stuck{.value = 0.5, .onset_s = 100.0};
  const ModelSpec whole = within({model()}, part, {1}, 1).model;
  CHECK_FALSE(whole.input_blocks[0]);
  REQUIRE(whole.channels.size() == 2);
  CHECK_FALSE(whole.channels[0].input_block);
  REQUIRE(whole.channels[1].input_block);
  CHECK(std::get<Stuck>(*whole.channels[1].input_block).value == 0.5);
}

TEST_CASE("where every CV is read only now and then the sample time is what is wrong") {
  Recording recording = plant(1.4, 10);
  read_every(10, 0, recording.cvs.col(1));
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
  const ModelSpec again = within({whole}, {part}, second, 1).model;
  CHECK(again.cv_count == 2);
  REQUIRE(again.channels.size() == 2);
  CHECK(again.channels[1].cv == 1);
  CHECK(again.output_origin(0) == 5.0);
  CHECK(again.output_origin(1) == 8.0);
  REQUIRE(again.disturbances.size() == 2);
  CHECK(again.disturbances[1].cv == 1);
}

// Of three signals that are no inputs the first CV answers the second one, the second CV the third
// and the second.
TEST_CASE("signals that parts of a model take as inputs are inputs of the whole once") {
  Extended whole{model()};
  const auto with_new = [](std::vector<ChannelSpec> channels, std::vector<int> new_inputs) {
    const int inputs = 1 + static_cast<int>(new_inputs.size());
    Extended part{test::model_of(std::move(channels), inputs, 1), std::move(new_inputs)};
    part.model.input_origin.tail(inputs - 1).setConstant(4.0);
    return part;
  };
  whole = within(whole, with_new({lag(0, 0, 1.1, 20.0), lag(0, 1, 3.0, 5.0)}, {1}), {0}, 1);
  whole = within(whole,
                 with_new({lag(0, 0, 2.2, 10.0), lag(0, 1, 6.0, 5.0), lag(0, 2, 7.0, 5.0)}, {2, 1}),
                 {1}, 1);
  CHECK(whole.new_inputs == std::vector<int>{1, 2});
  CHECK(whole.model.input_count == 3);
  CHECK(whole.model.input_blocks.size() == 3);
  REQUIRE(whole.model.input_origin.size() == 3);
  CHECK(whole.model.input_origin(2) == 4.0);
  const auto gain = [&](int cv, int input) {
    for (const ChannelSpec& channel : whole.model.channels)
      if (channel.cv == cv && channel.input == input)
        return std::get<TransferFunction>(channel.dynamics).gain;
    return 0.0;
  };
  CHECK(whole.model.channels.size() == 5);
  CHECK(gain(0, 0) == 1.1);
  CHECK(gain(0, 1) == 3.0);
  CHECK(gain(1, 0) == 2.2);
  CHECK(gain(1, 2) == 6.0);
  CHECK(gain(1, 1) == 7.0);
}

}  // namespace
}  // namespace mpm::seldom_read_test
