#include "core/identify/diagnosis/diagnosis.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/parallel/parallel.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::diagnosis_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
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

// 2 % of the time constant is half of what the monitor bears. Left out of the search it was given
// to another cause: the play of a valve, for a PI loop that ramps its input.
TEST_CASE("an error too small to matter is told as one, and for nothing else") {
  constexpr Index kLong = 3000;
  constexpr double kDeadTime = 3.0, kSlow = 150.0;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CAPTURE(seed);
    VectorXd u(kLong), y(kLong), measured(kLong);
    VectorXd inside = VectorXd::Zero(kLong + 4);
    const double keep = std::exp(-1.0 / kSlow);
    const VectorXd setpoint = 2.0 * test::telegraph(seed, kLong, 300);
    const VectorXd noise = 0.02 * test::white(seed + 10, kLong);
    double sum = 0.0;
    for (Index k = 0; k < kLong; ++k) {
      y(k) = inside(k);
      measured(k) = y(k) + noise(k);
      sum += (setpoint(k) - measured(k)) / 200.0;
      u(k) = 0.5 * (setpoint(k) - measured(k)) + sum;
      const double acts = k < 3 ? 0.0 : u(k - static_cast<Index>(kDeadTime));
      inside(k + 1) = keep * inside(k) + 2.0 * (1.0 - keep) * acts;
    }
    DiagnosisSettings settings;
    settings.mv_count = 1;
    const Diagnosis diagnosis = diagnose(test::model_of({lag(0, 0, 2.0, kSlow)}, 1, 1),
                                         test::recording_of(u, measured), nullptr, settings);
    CHECK(diagnosis.verdict == DiagnosisVerdict::kMatch);
    CHECK(diagnosis.findings.empty());
    REQUIRE(diagnosis.small.size() == 1);
    CHECK(diagnosis.small[0].subject == Subject{&causes::dead_time(), {0, 0}});
    const Parameter* dead_time = diagnosis.small[0].find(kDeadTimeError);
    REQUIRE(dead_time != nullptr);
    CHECK(dead_time->value == Approx(kDeadTime).margin(0.3));
  }
}

TEST_CASE("a hidden gain is named, measured and repaired") {
  const Diagnosis diagnosis = diagnosis_of(plant(1.4));
  CHECK(diagnosis.verdict == DiagnosisVerdict::kMismatch);
  REQUIRE(diagnosis.findings.size() == 1);
  const Finding& finding = diagnosis.findings[0];
  CHECK(finding.subject == Subject{&causes::gain(), {0, 0}});
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

/// Two CVs of two inputs. From `kChanged` on the first input acts `actuator` times, the first CV's
/// sensor shows `sensor` times and the first channel answers `channel` times as much as before.
constexpr Index kLonger = 2400, kChanged = 1000;
Diagnosis diagnosis_of_change(double actuator, double sensor, double channel) {
  MatrixXd u(kLonger, 2), acts(kLonger, 2), y(kLonger, 2);
  u << test::telegraph(1, kLonger, 12), test::telegraph(3, kLonger, 9);
  acts = u;
  acts.col(0).tail(kLonger - kChanged) *= actuator;
  VectorXd own = acts.col(0);
  own.tail(kLonger - kChanged) *= channel;
  y.col(0) = test::first_order(own, 2.0, 10.0) + test::first_order(acts.col(1), -1.0, 5.0);
  y.col(0).tail(kLonger - kChanged) *= sensor;
  y.col(1) = test::first_order(acts.col(0), 1.0, 5.0) + test::first_order(acts.col(1), 1.5, 10.0);
  for (int cv = 0; cv < 2; ++cv)
    y.col(cv) +=
        0.1 * test::autoregressive(test::normal(static_cast<std::uint64_t>(7 + cv), kLonger), 0.5);
  return diagnose(test::model_of({lag(0, 0, 2.0, 10.0), lag(0, 1, -1.0, 5.0), lag(1, 0, 1.0, 5.0),
                                  lag(1, 1, 1.5, 10.0)},
                                 2, 2),
                  test::recording_of(u, y), nullptr, {.mv_count = 2});
}

TEST_CASE("a span or an actuator that changes half-way is named as such, with its moment") {
  const auto named = [](const Diagnosis& diagnosis, const Subject& subject, double ratio) {
    CHECK(diagnosis.verdict == DiagnosisVerdict::kMismatch);
    REQUIRE(diagnosis.findings.size() == 1);
    const Finding& finding = diagnosis.findings.front();
    CHECK(finding.subject == subject);
    CHECK(finding.confidence > 0.9);
    REQUIRE(finding.find(kGainRatio) != nullptr);
    CHECK(finding.find(kGainRatio)->value == Approx(ratio).margin(0.04));
    REQUIRE(finding.onset_s);
    CHECK(*finding.onset_s == Approx(static_cast<double>(kChanged)).margin(20.0));
    CHECK(finding.repaired);
  };
  named(diagnosis_of_change(1.0, 0.75, 1.0), {&causes::output_scale(), {0}}, 0.75);
  named(diagnosis_of_change(0.7, 1.0, 1.0), {&causes::input_scale(), {-1, 0}}, 0.7);
  named(diagnosis_of_change(1.0, 1.0, 0.7), {&causes::gain(), {0, 0}}, 0.7);
  CHECK(diagnosis_of_change(1.0, 1.0, 1.0).verdict == DiagnosisVerdict::kMatch);
}

/// What a valve makes of its commands that sticks from a row on: it rests until the force beats the
/// static friction, then slips up to the kinetic one (He, Wang, Pottmann and Qin 2007).
VectorXd stuck_from(Index row, double band, double jump, const VectorXd& commands) {
  VectorXd valve = commands;
  for (Index k = row; k < commands.size(); ++k) {
    const double force = commands(k) - valve(k - 1);
    const bool slips = std::abs(force) >= (band + jump) / 2.0;
    valve(k) = slips ? commands(k) - std::copysign((band - jump) / 2.0, force) : valve(k - 1);
  }
  return valve;
}

TEST_CASE("a valve that begins to stick half-way is named, with its moment") {
  constexpr double kBand = 0.6, kJump = 0.25;
  const VectorXd u = 0.1 * test::autoregressive(test::normal(31, kLonger), 0.98);
  const VectorXd valve = stuck_from(kChanged, kBand, kJump, u);
  MatrixXd y(kLonger, 2);
  y << test::first_order(valve, 2.0, 10.0), test::first_order(valve, -1.0, 5.0);
  for (int cv = 0; cv < 2; ++cv)
    y.col(cv) += 0.05 * test::normal(static_cast<std::uint64_t>(41 + cv), kLonger);
  const Diagnosis diagnosis =
      diagnose(test::model_of({lag(0, 0, 2.0, 10.0), lag(1, 0, -1.0, 5.0)}, 1, 2),
               test::recording_of(u, y), nullptr, {.mv_count = 1});
  REQUIRE(diagnosis.findings.size() == 1);
  const Finding& finding = diagnosis.findings.front();
  CHECK(finding.subject == Subject{&causes::stiction(), {-1, 0}});
  REQUIRE(finding.parameters.size() == 2);
  CHECK(finding.parameters[0].value == Approx(kBand).margin(0.05));
  CHECK(finding.parameters[1].value == Approx(kJump).margin(0.08));
  REQUIRE(finding.onset_s);
  CHECK(*finding.onset_s == Approx(static_cast<double>(kChanged)).margin(60.0));
}

// The position of a valve is no signal from outside, though it explains what the command does not:
// it is told how the valve sticks. One that does as told is recorded by exception: in the record it
// stands still and jumps, as if it stuck.
TEST_CASE("a valve that sticks is named beside its measured position, and only where CVs feel it") {
  constexpr double kBand = 0.6, kJump = 0.25;
  VectorXd u = 0.1 * test::autoregressive(test::normal(31, kLonger), 0.98);
  u.array() -= u(0);  // the valve begins where the model has it
  const VectorXd stuck = stuck_from(1, kBand, kJump, u);
  for (const bool sticks : {true, false}) {
    CAPTURE(sticks);
    const VectorXd y =
        test::first_order(sticks ? stuck : u, 2.0, 10.0) + 0.05 * test::normal(41, kLonger);
    Recording recording = test::recording_of(u, y);
    recording.aux = VectorXd::Zero(kLonger);
    recording.aux.bottomRows(kLonger - 1) =
        (sticks ? stuck : stuck_from(1, kBand, kBand, u)).head(kLonger - 1);
    const Diagnosis diagnosis =
        diagnose(test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1), recording, nullptr, {.mv_count = 1});
    REQUIRE(diagnosis.findings.size() == (sticks ? 1 : 0));
    if (!sticks) continue;
    const Finding& finding = diagnosis.findings.front();
    CHECK(finding.subject == Subject{&causes::stiction(), {0, 0}});
    CHECK(finding.repaired);
    CHECK(finding.parameters[0].value == Approx(kBand).margin(0.05));
    CHECK(finding.parameters[1].value == Approx(kJump).margin(0.08));
  }
}

// What a stranger tries first: +-1 on the input, and a plant that answers twice as strongly. Two
// levels and an offset hold any curve, and a valve that sticks for less than a move is none.
TEST_CASE("a gain is no curve, no offset and no sticking valve to a binary test signal") {
  for (const std::uint64_t stream : {1U, 3U, 5U}) {
    const VectorXd u = test::telegraph(stream, kRows, 1);
    const Diagnosis diagnosis =
        diagnosis_of(test::recording_of(u, 2.0 * test::first_order(u, 2.0, 10.0) + noise()));
    REQUIRE(diagnosis.findings.size() == 1);
    CHECK(diagnosis.findings[0].subject == Subject{&causes::gain(), {0, 0}});
    CHECK(diagnosis.findings[0].parameters[0].value == Approx(2.0).margin(0.1));
  }
}

// There is one sample of dead time to take away, and a fit from beside it must find that.
TEST_CASE("a dead time that is not there is named, with whatever else is wrong of the channel") {
  const ModelSpec late = test::model_of({lag(0, 0, 2.0, 5.0, 1.0)}, 1, 1);
  for (const bool graded : {false, true})
    for (const double gain : {1.0, 2.0}) {
      CAPTURE(graded, gain);
      const VectorXd u = graded ? test::white(9, kRows) : test::telegraph(9, kRows, 1);
      DiagnosisSettings settings;
      settings.mv_count = 1;
      const Diagnosis diagnosis = diagnose(
          late, test::recording_of(u, gain * test::first_order(u, 2.0, 5.0) + 0.5 * noise()),
          nullptr, settings);
      REQUIRE(diagnosis.findings.size() == 1);
      const Finding& finding = diagnosis.findings[0];
      CHECK(finding.subject ==
            Subject{gain == 1.0 ? &causes::dead_time() : &causes::dynamics(), {0, 0}});
      CHECK(finding.parameters.back().value == Approx(-1.0).margin(0.1));
    }
}

// A random walk under white noise (IMA) on a CV whose model is right, of a plant whose time
// constant is a tenth of the data: no piece of it is a drift, a shift or a cycle. Two of twenty may
// be said to have one (1 % of walks pass for tame however they are cut: more than two of twenty
// with a probability of 1e-3). A drift of 3 in noise that forgets is one.
TEST_CASE("a random walk is not cut into drifts and shifts", "[trials]") {
  constexpr Index kLong = 3000;
  constexpr double kSlow = 300.0;
  const VectorXd u = test::telegraph(31, kLong, 400);
  const auto disturbances = [&](const VectorXd& noise) {
    const VectorXd y = test::first_order(u, 2.0, kSlow, 20) + noise;
    const Diagnosis diagnosis = diagnose(test::model_of({lag(0, 0, 2.0, kSlow, 20.0)}, 1, 1),
                                         test::recording_of(u, y), nullptr, {.mv_count = 1});
    return std::count_if(
        diagnosis.findings.begin(), diagnosis.findings.end(),
        [](const Finding& finding) { return !finding.subject.cause->acts_through_channels(); });
  };
  int walks = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    walks += disturbances(0.02 * test::autoregressive(test::normal(700 + seed, kLong), 1.0) +
                          0.05 * test::normal(800 + seed, kLong)) > 0
                 ? 1
                 : 0;
  CHECK(walks <= 2);
  const VectorXd drift = VectorXd::LinSpaced(kLong, 0.0, 3.0);
  CHECK(disturbances(drift + 0.2 * test::normal(900, kLong)) == 1);
}

// The controller or the plant itself takes it back. A CV that jumped is otherwise said to be
// shifted, which the unseen rows refuse, or gets an unexplained rest. Hidden: a jump of 0.8 in
// noise of 0.12 at row 150 that passes with a time constant of 60 s, and is gone before the unseen
// rows.
TEST_CASE("a disturbance that passes is named, with how long it takes, and is no repair") {
  for (const double size : {0.8, -0.8}) {
    VectorXd added = VectorXd::Zero(kRows);
    for (Index k = 150; k < kRows; ++k)
      added(k) = size * std::exp(-static_cast<double>(k - 150) / 60.0);
    const Diagnosis diagnosis = diagnosis_of(plant(1.0, added));
    REQUIRE(diagnosis.findings.size() == 1);
    const Finding& finding = diagnosis.findings[0];
    CHECK(finding.subject == Subject{&causes::step_disturbance(), {0}});
    CHECK(*finding.onset_s == Approx(150.0).margin(3.0));
    REQUIRE(finding.parameters.size() == 2);
    CHECK(finding.parameters[0].value == Approx(size).epsilon(0.25));
    CHECK(finding.parameters[1].name() == "decay");
    CHECK(finding.parameters[1].low < 60.0);
    CHECK(finding.parameters[1].high > 60.0);
    CHECK_FALSE(finding.repaired);
    CHECK(finding.explains == 0.0);
    CHECK(finding.refused == "it had passed before the samples on which repairs are measured");
    CHECK(diagnosis.extended.disturbances.empty());
    CHECK(diagnosis.refused.empty());
    CHECK(diagnosis.after == diagnosis.before);
  }
}

// The same of 0.3, two and a half s.d. of the noise: enough beside rows that bear it out, and there
// are none.
TEST_CASE("what has passed and hardly shows is not named") {
  VectorXd added = VectorXd::Zero(kRows);
  for (Index k = 150; k < kRows; ++k)
    added(k) = 0.3 * std::exp(-static_cast<double>(k - 150) / 60.0);
  const Diagnosis diagnosis = diagnosis_of(plant(1.0, added));
  CHECK(diagnosis.findings.empty());
  REQUIRE(diagnosis.refused.size() == 1);
  CHECK(diagnosis.refused[0].subject == Subject{&causes::step_disturbance(), {0}});
  CHECK(diagnosis.refused[0].evidence < 30.0);
}

// A shock is what noise of that colour makes of one large sample: each of twelve in noise that
// forgets by a tenth a sample. None is an event that began.
TEST_CASE("a shock of the noise is no disturbance that passes") {
  const VectorXd u = test::telegraph(1, kRows, 12);
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    VectorXd innovations = test::normal(seed, kRows);
    innovations(static_cast<Index>(100 + 30 * seed)) += seed % 2 == 0 ? 12.0 : -12.0;
    const Diagnosis diagnosis = diagnosis_of(test::recording_of(
        u, test::first_order(u, 2.0, 10.0) + 0.1 * test::autoregressive(innovations, 0.9)));
    CHECK(diagnosis.findings.empty());
  }
}

TEST_CASE("a sensor that clips is read from its plateau") {
  Recording recording = plant(1.0);
  recording.cvs = recording.cvs.cwiseMin(1.4);
  const Diagnosis diagnosis = diagnosis_of(recording);
  REQUIRE(diagnosis.findings.size() == 1);
  CHECK(diagnosis.findings[0].subject == Subject{&causes::output_saturation(), {0}});
  REQUIRE(diagnosis.findings[0].parameters.size() == 1);
  CHECK(diagnosis.findings[0].parameters[0].name() == "high");
  CHECK(diagnosis.findings[0].parameters[0].value == Approx(1.4).epsilon(1e-4));
  CHECK(diagnosis.findings[0].repaired);  // beyond doubt, so that unseen rows are not asked
  CHECK(diagnosis.extended.output_blocks[0].has_value());
  CHECK(diagnosis.refused.empty());
  CHECK_FALSE(diagnosis.scores[0].refused);
}

TEST_CASE("noise that becomes four times as strong is a finding without a repair") {
  Recording recording = plant(1.0);
  VectorXd louder = noise();
  recording.cvs.col(0).segment(300, 600) += louder.segment(300, 600);
  const Diagnosis diagnosis = diagnosis_of(recording);
  REQUIRE(diagnosis.findings.size() == 1);
  CHECK(diagnosis.findings[0].subject == Subject{&causes::noise(), {0}});
  CHECK(diagnosis.findings[0].parameters[0].low < 4.0);
  CHECK(diagnosis.findings[0].parameters[0].high > 4.0);
  REQUIRE(diagnosis.findings[0].onset_s);
  CHECK(*diagnosis.findings[0].onset_s == Approx(300.0).margin(40.0));
  CHECK(diagnosis.after == diagnosis.before);
}

constexpr Index kFitted = 600;
constexpr double kWhite = 0.1;

ModelSpec model_of_two() {
  return test::model_of({lag(0, 0, 2.0, 10.0), lag(1, 1, 1.0, 5.0)}, 2, 2);
}

/// The first input acts with `fitted` times its gain in the rows that are fitted, with `unseen`
/// times in the others; the second CV is as the model says.
Recording two_cvs(double fitted, double unseen) {
  MatrixXd u(kRows, 2), y(kRows, 2);
  u << test::telegraph(1, kRows, 12), test::telegraph(2, kRows, 9);
  const VectorXd response = test::first_order(u.col(0), 2.0, 10.0);
  y.col(0) = response + kWhite * test::white(3, kRows);
  y.col(0).head(kFitted) += (fitted - 1.0) * response.head(kFitted);
  y.col(0).tail(kRows - kFitted) += (unseen - 1.0) * response.tail(kRows - kFitted);
  y.col(1) = test::first_order(u.col(1), 1.0, 5.0) + kWhite * test::white(4, kRows);
  return test::recording_of(u, y);
}

double rms(const VectorXd& values) { return std::sqrt(values.cwiseAbs2().mean()); }

// What the extended model leaves is the noise, whose rms over 300 rows is known to 2.6 %.
// y(k+1) = p y(k) + K (1 - p) (u(k) - q y(k)^2): near where the force leaves the CV no rest.
TEST_CASE("a CV that is pushed back out of proportion is said to be no more than that") {
  constexpr Index kLong = 1800, kHold = 15;
  constexpr double kForce = 0.1;
  const double pole = std::exp(-1.0 / 10.0);
  int covered = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    CAPTURE(seed);
    VectorXd u(kLong), y = VectorXd::Zero(kLong);
    for (Index k = 0; k < kLong; ++k) u(k) = 0.2 + 0.8 * test::uniform(seed, k / kHold);
    for (Index k = 0; k + 1 < kLong; ++k)
      y(k + 1) = pole * y(k) + 2.0 * (1.0 - pole) * (u(k) - kForce * y(k) * y(k));
    y += 0.02 * test::autoregressive(test::normal(100 + seed, kLong), 0.8);
    const Diagnosis diagnosis = diagnosis_of(test::recording_of(u, y));
    REQUIRE_FALSE(diagnosis.findings.empty());
    const Finding& first = diagnosis.findings.front();
    CHECK(first.subject.cause == &causes::cubic_stiffness());
    REQUIRE(first.parameters.size() == 2);  // not what the channel has right as well
    CHECK(first.parameters[0].value == Approx(kForce).epsilon(0.25));
    covered += first.parameters[0].low <= kForce && kForce <= first.parameters[0].high ? 1 : 0;
  }
  CHECK(covered >= 2);  // of 95 % intervals: by chance fewer in 0.05 %
}

// y = 2 (u - 0.5 y^2) has no root for u = -1, and one for u = -0.01.
TEST_CASE("a model that runs away is said to, on the recording or on the unseen one") {
  ModelSpec running = model();
  running.state_terms = {{0, 0, RestoringForce{0.5, 0.0}}};
  Recording still = plant(1.0);
  still.inputs *= 0.01;
  const auto reason = [&](const Recording& of, const Recording* unseen) {
    return diagnose(running, of, unseen, {}).reason;
  };
  const Recording loud = plant(1.0);
  CHECK_THAT(reason(loud, nullptr), Catch::Contains("the model runs away"));
  CHECK_THAT(reason(still, &loud), Catch::Contains("the model runs away"));
  CHECK_THAT(reason(still, &still), !Catch::Contains("runs away"));
}

// y = K (u - 0.1 y^2) has a root down to u = -0.625 for K = 2, and to -0.613 for one 1 % larger.
TEST_CASE("a model that a small error makes run away is diagnosed as far as it goes") {
  ModelSpec near = model();
  near.state_terms = {{0, 0, RestoringForce{0.1, 0.0}}};
  VectorXd u = 0.3 * test::telegraph(1, kRows, 12), y = VectorXd::Zero(kRows);
  u.segment(100, 450).setConstant(-0.62);
  const double pole = std::exp(-1.0 / 10.0);
  for (Index k = 0; k + 1 < kRows; ++k)
    y(k + 1) = pole * y(k) + 2.0 * (1.0 - pole) * (u(k) - 0.1 * y(k) * y(k));
  const Diagnosis diagnosis = diagnose(near, test::recording_of(u, y + noise()), nullptr, {});
  CHECK(diagnosis.verdict != DiagnosisVerdict::kMismatch);
  REQUIRE(diagnosis.channels.size() == 1);
  CHECK(diagnosis.channels[0].gain_ratio.low < diagnosis.channels[0].gain_ratio.high);
}

TEST_CASE("a repair that carries over is measured on rows that no fit has seen") {
  const Recording all = two_cvs(1.5, 1.5);
  const Diagnosis diagnosis = diagnose(model_of_two(), all, nullptr, {});
  REQUIRE(diagnosis.scores.size() == 2);
  const CvScore& repaired = diagnosis.scores[0];
  const VectorXd response = test::first_order(all.inputs.col(0), 2.0, 10.0);
  CHECK(repaired.rmse_before ==
        Approx(rms((0.5 * response + kWhite * test::white(3, kRows)).tail(300))).epsilon(0.01));
  CHECK(repaired.rmse_after == Approx(kWhite).epsilon(0.08));
  const double gain = 1.0 - repaired.rmse_after / repaired.rmse_before;
  CHECK(repaired.gain_low < gain);
  CHECK(repaired.gain_high > gain);
  CHECK(repaired.gain_low > 0.5);
  CHECK_FALSE(repaired.refused);
  CHECK(diagnosis.findings.size() == 1);
  CHECK(diagnosis.findings[0].repaired);
  CHECK(diagnosis.refused.empty());
  CHECK(std::get<TransferFunction>(diagnosis.extended.channels[0].dynamics).gain ==
        Approx(3.0).epsilon(0.02));

  const CvScore& other = diagnosis.scores[1];
  CHECK(other.rmse_after == other.rmse_before);
  CHECK(other.gain_low == 0.0);
  CHECK(other.gain_high == 0.0);
  CHECK(diagnosis.before.rows() == kRows);
  CHECK(diagnosis.after.col(1) == diagnosis.before.col(1));
  CHECK(diagnosis.validation_before.size() == 0);
}

TEST_CASE("a diagnosis refuses a repair that makes the unseen rows worse") {
  const Diagnosis diagnosis = diagnose(model_of_two(), two_cvs(1.5, 1.0), nullptr, {});
  CHECK(diagnosis.findings.empty());
  REQUIRE(diagnosis.refused.size() == 1);
  CHECK(diagnosis.refused[0].subject.cause == &causes::gain());
  CHECK_FALSE(diagnosis.refused[0].repaired);
  CHECK(diagnosis.scores[0].refused);
  CHECK(diagnosis.scores[0].rmse_after == diagnosis.scores[0].rmse_before);
  CHECK(std::get<TransferFunction>(diagnosis.extended.channels[0].dynamics).gain == 2.0);
  CHECK(diagnosis.after == diagnosis.before);
}

TEST_CASE("a repair is measured on a second recording where there is one") {
  const Recording all = two_cvs(1.5, 1.5);
  const Recording unseen = two_cvs(1.0, 1.0);  // there the model is right
  const Diagnosis diagnosis = diagnose(model_of_two(), all, &unseen, {});
  CHECK(diagnosis.refused.size() == 1);
  CHECK(diagnosis.validation_before.rows() == kRows);
  CHECK(diagnosis.scores[0].rmse_before == Approx(kWhite).epsilon(0.08));
  CHECK(rms(all.cvs.col(0) - diagnosis.before.col(0)) > 0.5);
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

/// Two CVs, a gain that is off, a swing that the model knows nothing of, a step late in the data.
Recording two_cvs_with_much_wrong() {
  Recording recording = two_cvs(1.3, 1.3);
  for (Index k = 0; k < kRows; ++k) {
    recording.cvs(k, 1) += 0.4 * std::sin(0.21 * static_cast<double>(k));
    if (k >= 250) recording.cvs(k, 0) -= 0.6;
  }
  return recording;
}

TEST_CASE("how many threads work on it is nowhere to be seen") {
  const Recording recording = two_cvs_with_much_wrong();
  DiagnosisSettings settings;
  settings.mv_count = 2;
  const Diagnosis one = diagnose(model_of_two(), recording, nullptr, settings);
  REQUIRE(one.findings.size() >= 2);
  for (const int threads : {2, 3, 8}) {
    CAPTURE(threads);
    settings.threads = threads;
    const Diagnosis other = diagnose(model_of_two(), recording, nullptr, settings);
    REQUIRE(other.findings.size() == one.findings.size());
    for (std::size_t i = 0; i < one.findings.size(); ++i) {
      const Finding &a = one.findings[i], &b = other.findings[i];
      CHECK(a.subject == b.subject);
      CHECK(a.evidence == b.evidence);
      CHECK(a.confidence == b.confidence);
      CHECK(a.onset_s == b.onset_s);
      REQUIRE(a.parameters.size() == b.parameters.size());
      for (std::size_t p = 0; p < a.parameters.size(); ++p) {
        CHECK(a.parameters[p].value == b.parameters[p].value);
        CHECK(a.parameters[p].low == b.parameters[p].low);
      }
      REQUIRE(a.rivals.size() == b.rivals.size());
      for (std::size_t r = 0; r < a.rivals.size(); ++r) {
        CHECK(a.rivals[r].subject == b.rivals[r].subject);
        CHECK(a.rivals[r].worse == b.rivals[r].worse);
      }
    }
    CHECK(one.after == other.after);
    CHECK(one.before == other.before);
  }
}

// On one thread 1409 times are told. On four, the share of the one that asked depends on the
// machine, from 375 on, so that it must be given up well before.
TEST_CASE("several threads are given up by the one that asked, which alone is told") {
  const Parallel home(1);
  DiagnosisSettings settings;
  settings.mv_count = 2;
  settings.threads = 4;
  for (const int told_at_most : {1, 40, 200}) {
    CAPTURE(told_at_most);
    int told = 0;
    bool always_home = true;
    settings.progress = [&](double) {
      always_home = always_home && home.at_home();
      return ++told < told_at_most;
    };
    const Diagnosis diagnosis =
        diagnose(model_of_two(), two_cvs_with_much_wrong(), nullptr, settings);
    CHECK(diagnosis.reason == "stopped");
    CHECK(diagnosis.findings.empty());
    CHECK(told == told_at_most);
    CHECK(always_home);
  }
}

// By hand: five rows for each of 3 numbers a channel, 8 of the noise and 4 others, in two thirds.
TEST_CASE("a model with more channels needs more rows") {
  CHECK(needed_samples(model()) == 15 * (3 + 8 + 4) / 2);
  ModelSpec three =
      test::model_of({lag(0, 0, 1.0, 5.0), lag(0, 1, 1.0, 5.0), lag(1, 0, 1.0, 5.0)}, 2, 2);
  CHECK(needed_samples(three) == 15 * (6 + 8 + 4) / 2);
}

}  // namespace
}  // namespace mpm::diagnosis_test
