#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "sim/loop/closed_loop.hpp"
#include "sim/mpc/linear_gain.hpp"
#include "sim/scenario/prepare.hpp"
#include "tests/sim/units.hpp"

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using mpm::Frame;
using mpm::SignalKind;
using mpm::config::UnitConfig;
using mpm::test::load_plant;

}  // namespace

TEST_CASE("every shipped plant is held by its controller, in all of 20 runs") {
  const std::string name =
      GENERATE("shell3x3", "wood_berry", "shell7x5", "ogunnaike_ray", "integrating_tank");
  CAPTURE(name);
  const UnitConfig unit = load_plant(name);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    mpm::sim::ClosedLoop loop(mpm::test::healthy_loop(unit, seed));
    constexpr int kSamples = 800;
    VectorXd squares = VectorXd::Zero(unit.model.cv_count);
    for (int k = 0; k < kSamples; ++k) {
      const Frame& frame = loop.step();
      squares += (frame[SignalKind::kSetpoint].values - frame[SignalKind::kCv].values).cwiseAbs2() /
                 kSamples;
    }
    REQUIRE(loop.finite());
    CHECK(loop.controller().held_count() == 0);
    CHECK(loop.controller().limited_count() < kSamples / 10);
    for (Index cv = 0; cv < squares.size(); ++cv) {
      const double amplitude = unit.simulation.setpoints[static_cast<std::size_t>(cv)].amplitude;
      if (amplitude == 0.0) continue;
      // A loop that did nothing would have 1, one that followed at once only the noise; the worst
      // run of 3000 samples has 0.37, short ones scatter more.
      CHECK(squares(cv) / (amplitude * amplitude) < 0.6);
    }
  }
}

TEST_CASE("gains of the Ogunnaike-Ray column have the published relative gain array") {
  const UnitConfig unit = load_plant("ogunnaike_ray");
  const MatrixXd gain = mpm::sim::operating_gain(unit.model, 3);
  CHECK(gain.determinant() == Approx(-0.522905).epsilon(1e-5));  // by Sarrus
  const MatrixXd relative = gain.cwiseProduct(gain.inverse().transpose());
  Eigen::Matrix3d published;
  published << 2.01, -0.72, -0.29, -0.65, 1.82, -0.18, -0.36, -0.10, 1.46;
  CHECK((relative - published).cwiseAbs().maxCoeff() < 0.006);
}

TEST_CASE("the full Shell problem holds the three CVs of the reduced one") {
  const UnitConfig full = load_plant("shell7x5"), reduced = load_plant("shell3x3");
  REQUIRE(full.model.channels.size() == 35);
  const MatrixXd gains = mpm::sim::operating_gain(full.model, 3);
  CHECK(gains(std::vector<int>{0, 1, 6}, Eigen::all) == mpm::sim::operating_gain(reduced.model, 3));
  // Two of the others, published in minutes: y5-u1 4.13, 8, 5 and y7-d2 1.26, 32, 0.
  for (const mpm::ChannelSpec& channel : full.model.channels) {
    const auto& tf = std::get<mpm::TransferFunction>(channel.dynamics);
    if (channel.cv == 4 && channel.input == 0) {
      CHECK(tf.gain == 4.13);
      CHECK(tf.time_constants_s.at(0) == 480.0);
      CHECK(tf.dead_time_s == 300.0);
    } else if (channel.cv == 6 && channel.input == 4) {
      CHECK(tf.gain == 1.26);
      CHECK(tf.time_constants_s.at(0) == 1920.0);
      CHECK(tf.dead_time_s == 0.0);
    }
  }
}

TEST_CASE("measured disturbances of the shipped plants move") {
  const std::string name = GENERATE("wood_berry", "shell7x5", "integrating_tank");
  CAPTURE(name);
  mpm::sim::ClosedLoop loop(mpm::test::healthy_loop(load_plant(name)));
  VectorXd squares;
  for (int k = 0; k < 500; ++k) {
    const VectorXd& values = loop.step()[SignalKind::kDv].values;
    if (k == 0) squares = VectorXd::Zero(values.size());
    squares += values.cwiseAbs2();
  }
  CHECK(squares.minCoeff() > 0.0);
}

TEST_CASE("a level that integrates is held with a wrong gain, not with a wrong sign") {
  mpm::sim::LoopSetup setup = mpm::test::healthy_loop(load_plant("integrating_tank"));
  setup.scenario.changes = {mpm::test::gain_change("level", "outflow", 0.7, 5000.0)};
  mpm::sim::hide_changes(setup);
  mpm::sim::ClosedLoop loop(setup);
  double largest = 0.0;
  for (int k = 0; k < 3000; ++k)
    largest = std::max(largest, std::abs(loop.step()[SignalKind::kCv].values(0)));
  CHECK(largest < 10.0);  // set-points +-3
  setup.scenario.changes[0].gain_ratio = -1.0;
  CHECK_THROWS_AS(mpm::sim::hide_changes(setup), mpm::sim::RefusedScenario);
}
