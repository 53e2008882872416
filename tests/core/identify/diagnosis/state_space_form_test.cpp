#include "core/identify/diagnosis/state_space_form.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/fit/channel_edit.hpp"
#include "core/model/linear_model.hpp"

namespace mpm {
namespace {

/// Two lags of 10 and 20 samples with a common input each, as a state space.
ModelSpec given() {
  ModelSpec model;
  model.sample_time_s = 1.0;
  model.input_count = model.cv_count = 2;
  StateSpaceSpec system;
  const double fast = std::exp(-0.1), slow = std::exp(-0.05);
  system.a = Eigen::Vector2d(fast, slow).asDiagonal();
  system.b = Eigen::Vector2d(1.0 - fast, 1.0 - slow).asDiagonal();
  system.c = (Eigen::Matrix2d() << 2.0, 1.0, 0.0, 3.0).finished();
  system.d = Eigen::Matrix2d::Zero();
  system.x0 = Eigen::Vector2d(0.5, 0.0);
  model.state_space = system;
  model.input_blocks.resize(2);
  model.output_blocks.resize(2);
  model.input_origin = model.output_origin = Eigen::VectorXd::Zero(2);
  return model;
}

/// Largest difference of two models' step responses of a channel.
double apart(const ModelSpec& a, const ModelSpec& b, int cv, int input) {
  const Eigen::VectorXd difference = LinearModel(a).impulse_response(cv, input, 300) -
                                     LinearModel(b).impulse_response(cv, input, 300);
  double level = 0.0, largest = 0.0;
  for (const double value : difference) largest = std::max(largest, std::abs(level += value));
  return largest;
}

TEST_CASE("a repaired state space keeps its own and has states for the repair") {
  const ModelSpec model = given();
  const ModelSpec base = in_channels(model);
  ModelSpec extended = base;
  ChannelError error;
  error.gain_ratio = 1.25;
  extended.channels[0] = edited(extended.channels[0], error, 1.0);  // CV 0, input 0
  const std::optional<ModelSpec> repaired = in_state_space(model, base, extended);
  REQUIRE(repaired);
  REQUIRE(repaired->state_space);
  const StateSpaceSpec& system = *repaired->state_space;
  // A quarter of a first-order lag is one state more.
  REQUIRE(system.a.rows() == 3);
  CHECK(system.a.topLeftCorner(2, 2) == model.state_space->a);
  CHECK(system.b.topRows(2) == model.state_space->b);
  CHECK(system.c.leftCols(2) == model.state_space->c);
  CHECK(system.a(2, 2) == Approx(std::exp(-0.1)).epsilon(1e-4));
  CHECK(system.x0(0) == 0.5);
  CHECK(system.x0(2) == 0.0);
  CHECK(repaired->channels.empty());
  // Gain 2.5 instead of 2, and the others as they were.
  CHECK(apart(*repaired, extended, 0, 0) < 2.5e-3);
  CHECK(apart(*repaired, model, 0, 1) == 0.0);
  CHECK(apart(*repaired, model, 1, 1) == 0.0);
}

TEST_CASE("dead time, time constants and new inputs find their states, too") {
  const ModelSpec model = given();
  const ModelSpec base = in_channels(model);
  ModelSpec extended = base;
  ChannelError error;
  error.time_constant_ratio = 1.5;
  error.dead_time_error_s = 4.0;
  extended.channels[1] = edited(extended.channels[1], error, 1.0);  // CV 0, input 1
  extended.input_count = 3;
  extended.input_blocks.resize(3);
  extended.input_origin = Eigen::VectorXd::Zero(3);
  extended.channels.push_back({1, 2, TransferFunction{0.7, {15.0}, 0.0, 3.0, false}, {}});
  const std::optional<ModelSpec> repaired = in_state_space(model, base, extended);
  REQUIRE(repaired);
  CHECK(repaired->state_space->a.rows() < 60);
  CHECK(repaired->state_space->b.cols() == 3);
  CHECK(apart(*repaired, extended, 0, 1) < 1e-3);
  CHECK(apart(*repaired, extended, 1, 2) < 0.7e-3);
  CHECK(apart(*repaired, extended, 0, 0) < 1e-9);
}

// The level of a tank behind a lag, with another gain and a dead time.
TEST_CASE("a repaired channel that integrates becomes states that integrate") {
  ModelSpec model;
  model.input_count = model.cv_count = 1;
  StateSpaceSpec states;
  states.a = (Eigen::MatrixXd(2, 2) << 1.0, 0.02, 0.0, 0.8).finished();
  states.b = (Eigen::MatrixXd(2, 1) << 0.0, 0.2).finished();
  states.c = (Eigen::MatrixXd(1, 2) << 1.0, 0.0).finished();
  states.d = Eigen::MatrixXd::Zero(1, 1);
  model.state_space = states;
  const ModelSpec base = in_channels(model);
  CHECK(in_state_space(model, base, base)->state_space->a == model.state_space->a);
  ModelSpec extended = base;
  extended.channels[0] = edited(extended.channels[0], {1.4, 1.0, 3.0}, 1.0);
  const std::optional<ModelSpec> repaired = in_state_space(model, base, extended);
  REQUIRE(repaired);
  REQUIRE(repaired->state_space);
  // A thousandth of what is reached is allowed; the slope is exact.
  LinearModel one(*repaired), other(extended);
  for (int k = 0; k < 10000; ++k) {
    one.advance(Eigen::VectorXd::Ones(1));
    other.advance(Eigen::VectorXd::Ones(1));
  }
  CHECK(one.output()(0) == Approx(other.output()(0)).epsilon(1e-4));
}

TEST_CASE("what is no longer linear stays in channels") {
  const ModelSpec model = given();
  const ModelSpec base = in_channels(model);
  ModelSpec extended = base;
  extended.channels[0].input_block = Saturation{-1.0, 1.0};
  CHECK_FALSE(in_state_space(model, base, extended));
}

TEST_CASE("where only a disturbance was found the state space is the same") {
  const ModelSpec model = given();
  ModelSpec extended = in_channels(model);
  extended.disturbances.push_back({.cv = 1, .onset_s = 10.0, .size = 2.0});
  const std::optional<ModelSpec> repaired = in_state_space(model, in_channels(model), extended);
  REQUIRE(repaired);
  CHECK(repaired->state_space->a == model.state_space->a);
  CHECK(repaired->disturbances.size() == 1);
}

}  // namespace
}  // namespace mpm
