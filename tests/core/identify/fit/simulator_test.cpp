#include "core/identify/fit/simulator.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::simulator_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;
using test::model_of;
using test::recording_of;

constexpr Index kRows = 120;

VectorXd step_at(Index row, double from = 0.0, double to = 1.0) {
  return VectorXd::NullaryExpr(kRows, [&](Index k) { return k < row ? from : to; });
}

// K (1 - e^{-(t - dead) / T}) from the moment of the step on, whatever the sampling.
TEST_CASE("a lag answers a step as its closed form says") {
  const double gain = 2.0, time_constant = 10.0, dead_time = 3.4;
  const Recording recording = recording_of(step_at(20), VectorXd::Zero(kRows));
  Simulator simulator(recording);
  const ModelSpec model = model_of({lag(0, 0, gain, time_constant, dead_time)}, 1, 1);
  const VectorXd y = simulator.cv(model, 0);
  for (Index k = 0; k < kRows; ++k) {
    const double since = static_cast<double>(k) - 20.0 - dead_time;
    const double expected = since > 0.0 ? gain * (1.0 - std::exp(-since / time_constant)) : 0.0;
    CHECK(y(k) == Approx(expected).margin(1e-12));
  }
}

TEST_CASE("a CV is the sum of its channels around the operating point") {
  const VectorXd u = test::telegraph(1, kRows, 7), v = test::telegraph(2, kRows, 5);
  MatrixXd inputs(kRows, 2);
  inputs << (u.array() + 3.0).matrix(), (v.array() - 1.0).matrix();
  const Recording recording = recording_of(inputs, MatrixXd::Constant(kRows, 2, 5.0));
  ModelSpec model =
      model_of({lag(0, 0, 2.0, 10.0), lag(0, 1, -1.0, 4.0, 2.0), lag(1, 1, 9.0, 3.0)}, 2, 2);
  model.input_origin << 3.0, -1.0;
  model.output_origin << 5.0, 5.0;
  Simulator simulator(recording);
  const VectorXd expected =
      (test::first_order(u, 2.0, 10.0) + test::first_order(v, -1.0, 4.0, 2)).array() + 5.0;
  CHECK(simulator.cv(model, 0).isApprox(expected, 1e-12));
}

// From rest at the operating point, or as if the first input had always been there: whichever the
// first measurements show.
TEST_CASE("a simulation begins where the first measurements say") {
  const ModelSpec model = model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  const VectorXd inputs = step_at(40, 1.0, 2.0);
  const Recording settled = recording_of(inputs, VectorXd::Constant(kRows, 2.1));
  Simulator at_inputs(settled);
  const VectorXd y = at_inputs.cv(model, 0);
  CHECK(y.head(41).isApproxToConstant(2.0, 1e-12));
  CHECK(y(50) == Approx(4.0 - 2.0 * std::exp(-1.0)).epsilon(1e-12));
  const Recording fresh = recording_of(inputs, VectorXd::Constant(kRows, 0.1));
  Simulator at_origin(fresh);
  CHECK(at_origin.cv(model, 0)(10) == Approx(2.0 - 2.0 * std::exp(-1.0)).epsilon(1e-12));
}

TEST_CASE("an unknown input is the last known one") {
  VectorXd inputs = step_at(20);
  inputs.segment(30, 15).setConstant(std::numeric_limits<double>::quiet_NaN());
  const ModelSpec model = model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  const Recording holed = recording_of(inputs, VectorXd::Zero(kRows));
  const Recording whole = recording_of(step_at(20), VectorXd::Zero(kRows));
  Simulator with(holed), without(whole);
  CHECK(with.cv(model, 0) == without.cv(model, 0));
}

// u + 0.5 u^2 in front of a lag; each channel may have its own; a sensor that clips comes last.
TEST_CASE("static blocks bend inputs, channels and CVs") {
  const VectorXd u = test::telegraph(3, kRows, 6) + test::telegraph(4, kRows, 4);
  const VectorXd bent = u + 0.5 * u.cwiseAbs2();
  const Recording recording = recording_of(u, MatrixXd::Zero(kRows, 2));
  ModelSpec model = model_of({lag(0, 0, 2.0, 10.0), lag(1, 0, 3.0, 5.0)}, 1, 2);
  model.input_blocks[0] = Polynomial{{1.0, 0.5}};
  model.channels[1].input_block = Saturation{-0.5, 0.5};
  model.output_blocks[0] = Saturation{-1.0, 1.0};
  Simulator simulator(recording);
  CHECK(simulator.cv(model, 0).isApprox(
      test::first_order(bent, 2.0, 10.0).cwiseMax(-1.0).cwiseMin(1.0), 1e-12));
  CHECK(simulator.cv(model, 1).isApprox(
      test::first_order(bent.cwiseMax(-0.5).cwiseMin(0.5), 3.0, 5.0), 1e-12));
}

// The product with a second input, which is unknown for a while and then counts as it was.
TEST_CASE("what goes with another input goes with where it was last seen") {
  const VectorXd u = test::telegraph(3, kRows, 6), v = test::telegraph(4, kRows, 9);
  MatrixXd inputs(kRows, 2);
  inputs << u, v;
  VectorXd held = v;
  for (Eigen::Index k = 20; k < 40; ++k) {
    held(k) = v(19);
    inputs(k, 1) = std::nan("");
  }
  const VectorXd acting = u.array() * (0.8 + 0.5 * (held.array() - 0.25));
  const Recording recording = recording_of(inputs, MatrixXd::Zero(kRows, 2));
  ModelSpec model = model_of({lag(0, 0, 2.0, 10.0), lag(1, 0, 3.0, 5.0)}, 2, 2);
  model.input_origin(1) = 0.25;
  model.input_blocks[0] = Product{1, 0.5, 0.8};
  Simulator simulator(recording);
  CHECK(simulator.cv(model, 0).isApprox(test::first_order(acting, 2.0, 10.0), 1e-12));
  model.input_blocks[0].reset();
  model.channels[1].input_block = Product{1, 0.5, 0.8};
  CHECK(simulator.cv(model, 0).isApprox(test::first_order(u, 2.0, 10.0), 1e-12));
  CHECK(simulator.cv(model, 1).isApprox(test::first_order(acting, 3.0, 5.0), 1e-12));
  // What is remembered of one operating point is not another's.
  model.input_origin(1) = 0.0;
  CHECK(simulator.cv(model, 1).isApprox(
      test::first_order(u.array() * (0.8 + 0.5 * held.array()), 3.0, 5.0), 1e-12));
}

TEST_CASE("disturbances are on the clock of the data") {
  Recording recording = recording_of(VectorXd::Zero(kRows), VectorXd::Zero(kRows));
  recording.start_s = 1000.0;
  ModelSpec model = model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  DisturbanceTerm step, drift;
  step.onset_s = 1030.0, step.size = 0.7, step.time_constant_s = 8.0;
  drift.shape = DisturbanceShape::kDrift;
  drift.onset_s = 1060.0, drift.size = 0.01;
  model.disturbances = {step, drift};
  Simulator simulator(recording);
  const VectorXd y = simulator.cv(model, 0);
  CHECK(y.head(31).isZero(0.0));
  CHECK(y(38) == Approx(0.7 * (1.0 - std::exp(-1.0))).epsilon(1e-12));
  CHECK(y(100) == Approx(0.7 * (1.0 - std::exp(-70.0 / 8.0)) + 0.4).epsilon(1e-12));
}

TEST_CASE("aux signals are inputs around their mean") {
  const VectorXd ambient = test::telegraph(5, kRows, 6).array() + 20.0;
  Recording recording = recording_of(VectorXd::Zero(kRows), VectorXd::Zero(kRows));
  recording.aux.resize(kRows, 2);
  recording.aux.col(0).setConstant(7.0);
  recording.aux.col(1) = ambient;
  recording.aux(3, 1) = std::nan("");  // 20 in truth, and so the mean's own
  const ModelSpec base = model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  ModelSpec model = with_aux_inputs(base, recording);
  CHECK(model.input_count == 3);
  CHECK(model.input_blocks.size() == 3);
  CHECK(model.channels.size() == 1);
  CHECK(model.input_origin(0) == 0.0);
  CHECK(model.input_origin(1) == Approx(7.0));
  double mean = 0.0;
  for (Index k = 0; k < kRows; ++k)
    if (k != 3) mean += ambient(k) / static_cast<double>(kRows - 1);
  CHECK(model.input_origin(2) == Approx(mean));
  model.channels.push_back(lag(0, 2, 1.5, 6.0));
  Simulator simulator(recording);
  CHECK(simulator.cv(model, 0).isApprox(
      test::first_order((ambient.array() - mean).matrix(), 1.5, 6.0), 1e-10));
}

TEST_CASE("what was simulated before does not change what comes after") {
  const VectorXd u = test::telegraph(6, kRows, 6);
  const Recording recording = recording_of(u, VectorXd::Zero(kRows));
  Simulator simulator(recording);
  for (const double gain : {1.0, 2.0, 1.0})
    for (const double time_constant : {5.0, 10.0, 5.0}) {
      const ModelSpec model = model_of({lag(0, 0, gain, time_constant)}, 1, 1);
      CHECK(simulator.cv(model, 0).isApprox(test::first_order(u, gain, time_constant), 1e-12));
    }
  ModelSpec model = model_of({lag(0, 0, 1.0, 5.0)}, 1, 1);
  model.input_blocks[0] = Polynomial{{3.0}};
  CHECK(simulator.cv(model, 0).isApprox(test::first_order(u, 3.0, 5.0), 1e-12));
}

TEST_CASE("what is no model simulates nothing that is a number") {
  const Recording recording = recording_of(step_at(20), VectorXd::Zero(kRows));
  Simulator simulator(recording);
  CHECK(simulator.cv(model_of({lag(0, 0, 1.0, -5.0)}, 1, 1), 0).hasNaN());
}

TEST_CASE("each run is simulated as if there were no other") {
  ModelSpec model = model_of({lag(0, 0, 2.0, 10.0, 2.0), lag(0, 1, -1.0, 4.0)}, 2, 1);
  model.channels[0].input_block = Deadband{0.5};
  model.state_terms = {{0, 1, SquareRootOutflow{-50.0}}};
  std::vector<Recording> runs;
  for (const std::uint64_t run : {1U, 2U, 3U}) {
    MatrixXd inputs(kRows, 2);
    inputs << test::telegraph(run, kRows, 7), test::telegraph(10 + run, kRows, 5);
    inputs.array() += static_cast<double>(run);  // some begin at rest elsewhere, some do not
    VectorXd measured = VectorXd::Constant(kRows, static_cast<double>(run) - 1.0);
    runs.push_back(recording_of(inputs, measured));
    runs.back().start_s = 1000.0 * static_cast<double>(run);
  }
  runs[1].inputs(0, 0) = runs[1].inputs(1, 0) = std::numeric_limits<double>::quiet_NaN();
  const Recording all = joined(runs);
  Simulator together(all);
  const VectorXd y = together.cv(model, 0);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    Simulator alone(runs[r]);
    CHECK(y.segment(static_cast<Index>(r) * kRows, kRows) == alone.cv(model, 0));
  }
}

}  // namespace
}  // namespace mpm::simulator_test
