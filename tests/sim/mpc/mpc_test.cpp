#include "sim/mpc/mpc.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/mpc/linear_gain.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/sim/units.hpp"

namespace {

using Eigen::VectorXd;
using mpm::LinearModel;
using mpm::config::UnitConfig;
using mpm::sim::Mpc;
using mpm::test::load_plant;

Mpc make_controller(const UnitConfig& unit, double feedback = 1.0) {
  return Mpc(unit.model, static_cast<int>(unit.mv.size()), unit.simulation, feedback);
}

UnitConfig siso(double gain, double time_constant_s, double dead_time_s) {
  UnitConfig unit;
  unit.mv.resize(1);
  unit.cv.resize(1);
  unit.model.input_count = 1;
  unit.model.cv_count = 1;
  unit.model.channels.push_back(
      {0, 0, mpm::TransferFunction{gain, {time_constant_s}, 0.0, dead_time_s, false}});
  return unit;
}

}  // namespace

TEST_CASE("a constant disturbance leaves no offset") {
  const UnitConfig unit = load_plant("shell3x3");
  Mpc controller = make_controller(unit);
  LinearModel plant(unit.model);
  const Eigen::Vector3d setpoint(0.3, -0.2, 0.1), disturbance(0.5, -0.4, 0.2);
  VectorXd input = VectorXd::Zero(3);
  for (int k = 0; k < 800; ++k) {
    input = controller.control(plant.output() + disturbance, setpoint, VectorXd(0));
    plant.advance(input);
  }
  CHECK((plant.output() + disturbance - setpoint).cwiseAbs().maxCoeff() < 1e-6);
  // The inputs that this takes: K u = r - d, by the gains of eq. 4.1.
  CHECK((unit.model.cv_count == 3));
  CHECK((LinearModel(unit.model).steady_gain() * input - (setpoint - disturbance)).norm() < 1e-5);
  CHECK(controller.held_count() == 0);
}

TEST_CASE("a plant with other gains is still controlled without offset") {
  UnitConfig unit = load_plant("shell3x3");
  Mpc controller = make_controller(unit);
  for (mpm::ChannelSpec& channel : unit.model.channels)
    std::get<mpm::TransferFunction>(channel.dynamics).gain *= channel.cv == 1 ? 1.2 : 0.9;
  LinearModel plant(unit.model);
  const Eigen::Vector3d setpoint(0.3, -0.2, 0.1);
  for (int k = 0; k < 1500; ++k)
    plant.advance(controller.control(plant.output(), setpoint, VectorXd(0)));
  CHECK((plant.output() - setpoint).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("without feedback a disturbance stays in the output") {
  const UnitConfig unit = load_plant("shell3x3");
  Mpc controller = make_controller(unit, 0.0);
  LinearModel plant(unit.model);
  const Eigen::Vector3d setpoint(0.3, -0.2, 0.1), disturbance(0.05, -0.04, 0.02);
  for (int k = 0; k < 800; ++k)
    plant.advance(controller.control(plant.output() + disturbance, setpoint, VectorXd(0)));
  CHECK((plant.output() - setpoint).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("the moves are the least-squares optimum where no limit is near") {
  // One CV, one MV, one block: du = sum s(l) r / (sum s(l)^2 + 1) with s(l) = 2 (1 - e^{-l/10}).
  UnitConfig unit = siso(2.0, 10.0, 0.0);
  unit.simulation.prediction_horizon = 30;
  unit.simulation.move_blocks = {5};
  Mpc controller = make_controller(unit);
  double product = 0.0, square = 1.0;
  for (int l = 1; l <= 30; ++l) {
    const double step = -2.0 * std::expm1(-l / 10.0);
    product += step * 0.7;
    square += step * step;
  }
  const VectorXd input =
      controller.control(VectorXd::Zero(1), VectorXd::Constant(1, 0.7), VectorXd(0));
  CHECK(input(0) == Approx(product / square).epsilon(1e-12));
  CHECK(controller.limited_count() == 0);
}

TEST_CASE("hard limits on MVs and moves hold to the last bit") {
  UnitConfig unit = load_plant("shell3x3");
  for (std::size_t mv = 0; mv < 3; ++mv) unit.simulation.mv_limits[mv] = {-0.3, 0.25, 0.07};
  Mpc controller = make_controller(unit);
  LinearModel plant(unit.model);
  VectorXd last = VectorXd::Zero(3);
  int at_limit = 0;
  for (int k = 0; k < 1000; ++k) {
    const double sign = (k / 100) % 2 == 0 ? 1.0 : -1.0;
    const VectorXd input =
        controller.control(plant.output(), sign * Eigen::Vector3d(1.5, -1.0, 0.8), VectorXd(0));
    REQUIRE(input.maxCoeff() <= 0.25);
    REQUIRE(input.minCoeff() >= -0.3);
    REQUIRE((input - last).cwiseAbs().maxCoeff() <= 0.07);
    at_limit += (input.array() == 0.25 || input.array() == -0.3).any();
    last = input;
    plant.advance(input);
  }
  CHECK(at_limit > 100);
  CHECK(controller.limited_count() > 100);
  CHECK(controller.held_count() == 0);
}

TEST_CASE("soft limits are kept where they can be, and left only as far as needed") {
  UnitConfig unit = siso(2.0, 10.0, 3.0);
  unit.simulation.prediction_horizon = 60;
  unit.simulation.move_blocks = {1, 1, 2, 4, 8};
  unit.simulation.cv_limits = {{std::nullopt, 1.0}};
  SECTION("a set-point above the limit is not followed beyond it") {
    Mpc controller = make_controller(unit);
    LinearModel plant(unit.model);
    for (int k = 0; k < 300; ++k) {
      plant.advance(controller.control(plant.output(), VectorXd::Constant(1, 1.6), VectorXd(0)));
      REQUIRE(plant.output()(0) <= 1.0 + 1e-6);
    }
    CHECK(plant.output()(0) == Approx(1.0).epsilon(1e-3));
  }
  SECTION("a disturbance that no move can meet in time goes above it, then comes back") {
    Mpc controller = make_controller(unit);
    LinearModel plant(unit.model);
    double measured = 0.0;
    int above = 0;
    for (int k = 0; k < 300; ++k) {
      measured = plant.output()(0) + (k >= 100 ? 0.8 : 0.0);
      if (measured > 1.0 + 1e-6) ++above;
      plant.advance(controller.control(VectorXd::Constant(1, measured), VectorXd::Constant(1, 0.9),
                                       VectorXd(0)));
    }
    CHECK(above >= 4);  // at 100, 101, 102, 103 the dead time of 3 leaves no choice
    CHECK(above < 30);
    CHECK(measured == Approx(0.9).epsilon(1e-6));
    CHECK(controller.held_count() == 0);
  }
}

TEST_CASE("a measured disturbance is met before it shows") {
  // One DV with the MV's dynamics but twice the dead time: feed-forward can cancel it.
  UnitConfig unit = siso(2.0, 10.0, 2.0);
  unit.dv.resize(1);
  unit.model.input_count = 2;
  unit.model.channels.push_back({0, 1, mpm::TransferFunction{1.0, {10.0}, 0.0, 8.0, false}});
  unit.simulation.prediction_horizon = 60;
  unit.simulation.move_blocks = {1, 1, 1, 1, 1, 1, 2, 4, 8};
  unit.simulation.move_weights = {0.001};
  Mpc controller = make_controller(unit);
  LinearModel plant(unit.model);
  double worst = 0.0;
  VectorXd input = VectorXd::Zero(2);
  for (int k = 0; k < 200; ++k) {
    const VectorXd disturbance = VectorXd::Constant(1, k >= 50 ? 1.0 : 0.0);
    input.head(1) = controller.control(plant.output(), VectorXd::Zero(1), disturbance);
    input.tail(1) = disturbance;
    plant.advance(input);
    worst = std::max(worst, std::abs(plant.output()(0)));
  }
  // Without feed-forward the output would rise for 2 samples after it shows: 1 - e^{-0.3} = 0.26.
  CHECK(worst < 0.01);
  CHECK(input(0) == Approx(-0.5).epsilon(1e-3));  // 2 u + 1 = 0
}

TEST_CASE("an MV that starts outside its limits comes back no faster than it may") {
  UnitConfig unit = siso(2.0, 10.0, 0.0);
  unit.model.input_origin = VectorXd::Constant(1, 5.0);
  unit.simulation.mv_limits = {{0.0, 4.0, 0.3}};
  Mpc controller = make_controller(unit);
  LinearModel plant(unit.model);
  double last = 5.0;
  for (int k = 0; k < 10; ++k) {
    const double now = controller.control(plant.output(), VectorXd::Zero(1), VectorXd(0))(0);
    CHECK(now == Approx(std::max(4.0, last - 0.3)));
    last = now;
    plant.advance(VectorXd::Constant(1, now));
  }
  CHECK(controller.held_count() > 0);
}

TEST_CASE("a control step with limits does not allocate") {
  UnitConfig unit = load_plant("shell3x3");
  for (std::size_t mv = 0; mv < 3; ++mv) unit.simulation.mv_limits[mv] = {-0.3, 0.25, 0.07};
  Mpc controller = make_controller(unit);
  const VectorXd measured = VectorXd::Zero(3), setpoint = VectorXd::Ones(3), none(0);
  const std::uint64_t before = mpm::test::allocation_count();
  for (int k = 0; k < 50; ++k) static_cast<void>(controller.control(measured, setpoint, none));
  CHECK(mpm::test::allocation_count() == before);
  CHECK(controller.limited_count() > 10);
}

TEST_CASE("settings that define no controller are refused") {
  UnitConfig unit = siso(2.0, 10.0, 0.0);
  unit.simulation.move_blocks = {};
  CHECK_THROWS_AS(make_controller(unit), std::invalid_argument);
  unit.simulation.move_blocks = {100, 1};
  CHECK_THROWS_AS(make_controller(unit), std::invalid_argument);
  unit.simulation.move_blocks = {5};
  unit.simulation.cv_weights = {0.0};
  unit.simulation.move_weights = {0.0};
  CHECK_THROWS_AS(make_controller(unit), std::invalid_argument);
}

TEST_CASE("a model that is not linear controls a plant of its own kind without offset") {
  // A tank with a valve that opens by the square around its middle: 1.2 u + 0.1 u^2; the model and
  // the plant both know the load that comes at 300 s, which is in sight 100 s before.
  UnitConfig unit = siso(2.0, 20.0, 0.0);
  unit.model.input_origin = VectorXd::Constant(1, 10.0);
  unit.model.output_origin = VectorXd::Constant(1, 30.0);
  unit.model.channels[0].dynamics = mpm::TankChain{{20.0, 10.0}, 0.0, 10.0, {}, 0.0, 1.5};
  unit.model.channels[0].input_block = mpm::Polynomial{{1.2, 0.1}};
  unit.model.disturbances.push_back({0, mpm::DisturbanceShape::kStep, 300.0, -4.0, 10.0});
  CHECK(mpm::sim::static_slopes(unit.model)(0, 0) == 1.2);
  CHECK(mpm::sim::operating_gain(unit.model, 1)(0, 0) == Approx(1.2 * 4.0));  // 2 x 20 / 10
  Mpc controller = make_controller(unit);
  LinearModel plant(unit.model);
  for (int k = 0; k < 600; ++k) {
    CHECK(controller.prediction() == plant.output());
    plant.advance(controller.control(plant.output(), VectorXd::Constant(1, 34.0), VectorXd(0)));
    if (k == 190 || k == 599) CHECK(plant.output()(0) == Approx(34.0).margin(1e-3));
  }
}
