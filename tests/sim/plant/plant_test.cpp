#include "sim/plant/plant.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "tests/sim/units.hpp"

namespace {

using Eigen::VectorXd;
using mpm::DiscreteFilter;
using mpm::LinearModel;
using mpm::ModelSpec;
using mpm::StepResponse;
using mpm::TransferFunction;
using mpm::sim::changed_model;
using mpm::sim::ChannelChange;
using mpm::sim::Plant;
using mpm::test::gain_change;
using mpm::test::load_plant;

template <class Dynamics>
ModelSpec siso(const Dynamics& dynamics) {
  ModelSpec spec;
  spec.input_count = 1;
  spec.cv_count = 1;
  spec.channels.push_back({0, 0, dynamics});
  return spec;
}

VectorXd step_of(const ModelSpec& spec, int length) {
  VectorXd step = LinearModel(spec).impulse_response(0, 0, length);
  for (Eigen::Index k = 1; k < length; ++k) step(k) += step(k - 1);
  return step;
}

}  // namespace

TEST_CASE("a change of a channel is the same in every form of the channel") {
  const double a = std::exp(-1.0 / 12.0);
  const ModelSpec transfer = siso(TransferFunction{3.0, {12.0}, 0.0, 2.0, false});
  const ModelSpec filter = siso(DiscreteFilter{{3.0 * (1.0 - a)}, {1.0, -a}, 2});
  StepResponse response;
  for (int k = 0; k < 500; ++k)
    response.values.push_back(k < 3 ? 0.0 : 3.0 * (1.0 - std::pow(a, k - 2)));
  ModelSpec space;
  space.input_count = 1;
  space.cv_count = 1;
  mpm::StateSpaceSpec system;
  system.a = Eigen::MatrixXd::Zero(3, 3);
  system.a(0, 0) = a;
  system.a(1, 0) = 1.0;
  system.a(2, 1) = 1.0;
  system.b = Eigen::Vector3d(3.0 * (1.0 - a), 0.0, 0.0);
  system.c = Eigen::RowVector3d(0.0, 0.0, 1.0);
  system.d = Eigen::MatrixXd::Zero(1, 1);
  space.state_space = system;

  // A stretched step response is linear between samples, and so off the exponential by at most
  // K T^2 / (8 tau^2) = 3 / (8 * 144) = 2.61e-3 times the gain ratio.
  for (const ChannelChange& change :
       {ChannelChange{0, 0, 0.8}, ChannelChange{0, 0, 1.0, 1.0, 4.0},
        ChannelChange{0, 0, 0.8, 1.5, 1.4}, ChannelChange{0, 0, 1.2, 0.7, -1.0}}) {
    const VectorXd expected = step_of(changed_model(transfer, {change}), 400);
    const bool exact = change.time_constant_ratio == 1.0;
    for (const ModelSpec& form : {filter, siso(response), space}) {
      const VectorXd step = step_of(changed_model(form, {change}), 400);
      CHECK((step - expected).cwiseAbs().maxCoeff() < (exact ? 1e-7 : change.gain_ratio * 2.61e-3));
    }
  }
  // The transfer function itself, by its parameters.
  const ModelSpec changed = changed_model(transfer, {ChannelChange{0, 0, 0.8, 1.5, 1.4}});
  const auto& dynamics = std::get<TransferFunction>(changed.channels[0].dynamics);
  CHECK(dynamics.gain == Approx(2.4));
  CHECK(dynamics.time_constants_s[0] == Approx(18.0));
  CHECK(dynamics.dead_time_s == Approx(3.4));
  for (const ModelSpec& form : {transfer, filter, siso(response), space})
    CHECK_THROWS_AS(changed_model(form, {ChannelChange{0, 0, 1.0, 1.0, -2.5}}),
                    std::invalid_argument);
}

TEST_CASE("one cell of a state space changes alone") {
  ModelSpec spec;
  spec.input_count = 2;
  spec.cv_count = 2;
  mpm::StateSpaceSpec system;
  system.a = Eigen::Vector2d(0.9, 0.8).asDiagonal();
  system.b = Eigen::Matrix2d::Identity();
  system.c.resize(2, 2);
  system.c << 1.0, 2.0, 0.0, 4.0;  // CV 2 does not see input 1
  system.d = Eigen::Matrix2d::Zero();
  spec.state_space = system;
  CHECK(mpm::sim::has_channel(spec, 0, 1));
  CHECK_FALSE(mpm::sim::has_channel(spec, 1, 0));
  const Eigen::MatrixXd gain =
      LinearModel(changed_model(spec, {ChannelChange{0, 1, 0.5}})).steady_gain();
  // C (I - A)^-1 B = [10 10; 0 20], the upper right one halved.
  CHECK(gain(0, 0) == Approx(10.0));
  CHECK(gain(0, 1) == Approx(5.0));
  CHECK(gain(1, 0) == 0.0);
  CHECK(gain(1, 1) == Approx(20.0));
}

TEST_CASE("a missing tag stands for all that the model has") {
  mpm::config::UnitConfig unit = load_plant("wood_berry");  // 2 MVs, 1 DV, 2 CVs
  mpm::config::Change all;
  all.gain_ratio = 2.0;
  CHECK(mpm::sim::resolve_changes({all}, unit).size() == 4);  // a missing MV is every MV, no DV
  all.mv = "feed";
  CHECK(mpm::sim::resolve_changes({all}, unit).size() == 2);
  all.cv = "xb";
  CHECK(mpm::sim::resolve_changes({all}, unit).size() == 1);
  all.mv = "nothing";
  CHECK_THROWS_AS(mpm::sim::resolve_changes({all}, unit), std::invalid_argument);
  unit.model.channels.pop_back();  // xb, feed
  all.mv = "feed";
  CHECK_THROWS_AS(mpm::sim::resolve_changes({all}, unit), std::invalid_argument);
}

TEST_CASE("a change takes hold at its onset and not before") {
  const ModelSpec model = siso(TransferFunction{2.0, {5.0}, 0.0, 1.0, false});
  Plant plant(model, {ChannelChange{0, 0, 1.5, 1.0, 0.0, 30.0}});
  LinearModel reference(model);
  const VectorXd input = VectorXd::Ones(1);
  for (int k = 0; k < 60; ++k) {
    const double ratio = k < 30 ? 1.0 : 1.5;
    CHECK(plant.output()(0) == Approx(ratio * reference.output()(0)).epsilon(1e-13));
    plant.advance(input);
    reference.advance(input);
  }
}

TEST_CASE("a level does not jump when its filling rate changes") {
  const ModelSpec model = siso(TransferFunction{0.1, {}, 0.0, 0.0, true});
  Plant plant(model, {ChannelChange{0, 0, 2.0, 1.0, 0.0, 10.0}});
  for (int k = 0; k < 20; ++k) {
    // 0.1 per second until 10 s, then 0.2.
    CHECK(plant.output()(0) == Approx(k <= 10 ? 0.1 * k : 1.0 + 0.2 * (k - 10)));
    plant.advance(VectorXd::Ones(1));
  }
}

TEST_CASE("changes add up in the order of their onsets") {
  const ModelSpec model = siso(TransferFunction{2.0, {5.0}, 0.0, 1.0, false});
  const auto stages = mpm::sim::plant_stages(
      model, {ChannelChange{0, 0, 1.5, 1.0, 0.0, 30.0}, ChannelChange{0, 0, 1.0, 1.0, 2.0, 10.0}});
  REQUIRE(stages.size() == 3);
  const auto& first = std::get<TransferFunction>(stages[1].model.channels[0].dynamics);
  const auto& second = std::get<TransferFunction>(stages[2].model.channels[0].dynamics);
  CHECK(first.gain == 2.0);
  CHECK(first.dead_time_s == 3.0);
  CHECK(second.gain == 3.0);
  CHECK(second.dead_time_s == 3.0);
}

TEST_CASE("a change that ends leaves the plant as the model") {
  const ModelSpec model = siso(TransferFunction{2.0, {5.0}, 0.0, 1.0, false});
  ChannelChange change{0, 0, 1.5, 1.0, 0.0, 30.0, 60.0};
  const auto stages = mpm::sim::plant_stages(model, {change});
  REQUIRE(stages.size() == 3);
  CHECK(std::get<TransferFunction>(stages[1].model.channels[0].dynamics).gain == 3.0);
  CHECK(std::get<TransferFunction>(stages[2].model.channels[0].dynamics).gain == 2.0);
  Plant changed(model, {change});
  mpm::LinearModel exact(model);
  for (int k = 0; k < 100; ++k) {
    const double ratio = k >= 30 && k < 60 ? 1.5 : 1.0;
    CHECK(changed.output()(0) == Approx(ratio * exact.output()(0)).epsilon(1e-12));
    changed.advance(VectorXd::Ones(1));
    exact.advance(VectorXd::Ones(1));
  }
}

TEST_CASE("tanks change as their linearisation does") {
  ModelSpec spec;
  spec.input_count = 1;
  spec.cv_count = 1;
  spec.input_origin = VectorXd::Constant(1, 5.0);
  spec.output_origin = VectorXd::Constant(1, 50.0);
  spec.channels.push_back({0, 0, mpm::TankChain{{10.0, 4.0}, 0.0, 20.0, {}, 0.0, 2.0}});
  const LinearModel before(spec);
  const ModelSpec changed = changed_model(spec, {ChannelChange{0, 0, 0.8, 1.5, 1.0}});
  const LinearModel after(changed);
  CHECK(after.steady_gain()(0, 0) == Approx(0.8 * before.steady_gain()(0, 0)));
  CHECK(after.slowest_time_constant_samples() == Approx(15.0));
  CHECK(after.longest_dead_time_samples() == Approx(3.0));
  CHECK_THROWS_AS(changed_model(spec, {ChannelChange{0, 0, 1.0, 1.0, -2.5}}),
                  std::invalid_argument);
}
