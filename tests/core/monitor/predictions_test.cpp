#include "core/monitor/predictions.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/monitor/unit_residuals.hpp"

#include "tests/core/channel_model.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::predictions_test {
namespace {

constexpr int kSettling = 20, kTurning = 30, kLost = 10;

ModelSpec first_order() {
  return test::channel_model(1, 1, {{0, 0, TransferFunction{2.0, {4.0}, 0, 1, false}}});
}

// One input, one CV; the frames go through a screen as in the monitor.
struct Unit {
  Unit()
      : model(first_order()),
        plant(first_order()),
        screen(counts, {true}, {true}, 0, kTurning),
        inputs(counts, 100.0),
        predictions(model, {true}, {true}, kSettling, kSettling, kLost),
        residuals(1) {}

  // Measured: the model's own output plus 1. NaN: unknown.
  void step(double u, double predicted, double noise = 0.0) {
    Frame frame(counts);
    for (SignalBlock& block : frame.blocks)
      std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
    const auto set = [&](SignalKind kind, double value) {
      frame[kind].values(0) = value;
      if (!std::isfinite(value)) frame[kind].quality[0] = Quality::kBad;
    };
    set(SignalKind::kMv, u);
    set(SignalKind::kCv, plant.output()(0) + 1.0 + noise);
    set(SignalKind::kPrediction, predicted);
    screen.push(frame);
    predictions.follow(screen, [&](int) { ++turned; });
    inputs.read(frame);
    predictions.begin(frame, inputs);
    residuals.read(frame, Eigen::VectorXd::Constant(1, predictions.predicted(0, frame)));
    predictions.compare(frame);
    predictions.advance(inputs);
    if (std::isfinite(u)) held = u;
    plant.advance(Eigen::VectorXd::Constant(1, held));
  }

  SignalCounts counts{1, 0, 1, 0};
  LinearModel model, plant;
  Screen screen;
  UnitInputs inputs;
  Predictions predictions;
  UnitResiduals residuals;
  double held = 0.0;
  int turned = 0;
};

const double kNone = std::nan("");

TEST_CASE("as long as no prediction comes it is simulated, once the model has settled") {
  Unit unit;
  for (int k = 0; k <= kSettling; ++k) {
    unit.step(k % 7 - 3.0, kNone);
    CHECK(std::isnan(unit.residuals.values()(0)));
  }
  CHECK(unit.residuals.unknown_run(0) == kSettling + 1);
  for (int k = 0; k < 40; ++k) unit.step(k % 5 - 2.0, kNone);
  // What the plant began with differs from what was assumed: exp(-5) of it is left, and less.
  CHECK(unit.residuals.values()(0) == Approx(1.0).margin(1e-3));
  CHECK(unit.residuals.unknown_run(0) == 0);
  CHECK(unit.turned == 0);
}

TEST_CASE("the first prediction that comes takes over, apart from what was simulated") {
  Unit unit;
  for (int k = 0; k < 40; ++k) unit.step(k % 5 - 2.0, kNone);
  unit.step(1.0, unit.plant.output()(0) - 0.5);
  CHECK(unit.turned == 1);
  CHECK(unit.predictions.given(0));
  // As many unknown ones as close all windows.
  for (int k = 0; k < 6; ++k) {
    CHECK(std::isnan(unit.residuals.values()(0)));
    unit.step(1.0, unit.plant.output()(0) - 0.5);
  }
  CHECK(unit.residuals.values()(0) == Approx(1.5));
  unit.step(1.0, kNone);
  CHECK(std::isnan(unit.residuals.values()(0)));
  CHECK(unit.residuals.held()(0) == Approx(1.5));
}

TEST_CASE(
    "predictions that have ceased are simulated after a while, and not once they last again") {
  Unit unit;
  const auto given = [&](int k) { unit.step(k % 5 - 2.0, unit.plant.output()(0) - 0.5); };
  const auto none = [&](int k) { unit.step(k % 5 - 2.0, kNone); };
  for (int k = 0; k < 40; ++k) given(k);
  CHECK(unit.turned == 1);
  CHECK(unit.residuals.values()(0) == Approx(1.5));

  for (int k = 0; k < kTurning - 1; ++k) none(k);
  given(0);  // one that comes is enough to go on with
  for (int k = 0; k < kTurning - 1; ++k) none(k);
  CHECK(unit.predictions.given(0));
  none(0);
  CHECK(unit.turned == 2);
  CHECK_FALSE(unit.predictions.given(0));
  for (int k = 0; k < kSettling; ++k) {
    CHECK(std::isnan(unit.residuals.values()(0)));
    none(k);
  }
  for (int k = 0; k < 40; ++k) none(k);
  CHECK(unit.residuals.values()(0) == Approx(1.0).margin(1e-3));

  for (int k = 0; k < kTurning - 1; ++k) given(k);
  none(0);
  for (int k = 0; k < kTurning - 1; ++k) {
    given(k);
    CHECK(unit.residuals.values()(0) == Approx(1.0).margin(1e-3));  // simulated still
  }
  given(0);
  CHECK(unit.turned == 3);
  for (int k = 0; k < 6; ++k) {
    CHECK(std::isnan(unit.residuals.values()(0)));
    given(k);
  }
  CHECK(unit.residuals.values()(0) == Approx(1.5));
}

TEST_CASE("an input that was unknown for long moved unseen: its simulation is not trusted") {
  Unit unit;
  for (int k = 0; k < 60; ++k) unit.step(k % 5 - 2.0, kNone);
  for (int k = 0; k < 5; ++k) unit.step(kNone, kNone);  // as if unchanged
  CHECK(unit.inputs.unknown_run(0) == 5);
  CHECK_FALSE(unit.predictions.settling(0));
  CHECK(std::isfinite(unit.residuals.values()(0)));
  unit.step(kNone, kNone);
  CHECK(unit.predictions.settling(0));
  CHECK(std::isnan(unit.residuals.values()(0)));
  for (int k = 0; k < kSettling; ++k) unit.step(k % 5 - 2.0, kNone);
  CHECK(std::isfinite(unit.residuals.values()(0)));
}

TEST_CASE("a long gap is distrusted likewise, a short one is not") {
  for (const int missing : {5, 6}) {
    Unit unit;
    for (int k = 0; k < 60; ++k) unit.step(k % 5 - 2.0, kNone);
    unit.predictions.skip(missing, unit.inputs);
    unit.residuals.skip(missing);
    CHECK(unit.predictions.settling(0) == (missing > 5));
    CHECK(unit.residuals.unknown_run(0) == missing);
  }
}

// The bias is that of an update in each sample; the noise is what tells it from a model.
TEST_CASE(
    "predictions that are corrected by the measurement are simulated instead, while they are") {
  Unit unit;
  double bias = 1.0;
  int k = 0;
  const auto step = [&](bool corrects) {
    const double noise = 0.1 * test::uniform(7, k), predicted = unit.plant.output()(0) + bias;
    if (corrects) bias += 0.8 * (unit.plant.output()(0) + 1.0 + noise - predicted);
    unit.step(k % 9 - 4.0, predicted, noise);
    ++k;
  };
  while (k < 190) step(true);
  CHECK(unit.predictions.given(0));
  while (k < 400) step(true);
  CHECK(unit.predictions.corrected(0));
  CHECK_FALSE(unit.predictions.given(0));
  CHECK(unit.turned == 2);
  const double noise = 0.1 * test::uniform(7, k - 1);
  CHECK(unit.residuals.values()(0) == Approx(1.0 + noise).margin(1e-6));
  // They are believed again once three blocks in a row say otherwise.
  bias = 0.0;
  while (k < 900) step(false);
  CHECK_FALSE(unit.predictions.corrected(0));
  CHECK(unit.predictions.given(0));
}

}  // namespace
}  // namespace mpm::predictions_test
