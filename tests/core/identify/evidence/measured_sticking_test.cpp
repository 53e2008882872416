#include "core/identify/evidence/measured_sticking.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::measured_sticking_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kRows = 1500;
constexpr double kBand = 0.6;

VectorXd command(std::uint64_t stream) {
  return 40.0 + (0.3 * test::autoregressive(test::normal(stream, kRows), 0.97)).array();
}

/// A valve that rests until the force on it beats the static friction, then slips up to the kinetic
/// one (He, Wang, Pottmann and Qin 2007).
VectorXd sticking(const VectorXd& command, double band, double jump) {
  VectorXd valve = command;
  for (Index k = 1; k < command.size(); ++k) {
    const double force = command(k) - valve(k - 1);
    const bool slips = std::abs(force) >= (band + jump) / 2.0;
    valve(k) = slips ? command(k) - std::copysign((band - jump) / 2.0, force) : valve(k - 1);
  }
  return valve;
}

/// What is measured of a position, from the next row on, with a noise of `noise`.
VectorXd measured(const VectorXd& position, double noise) {
  VectorXd signal = noise * test::normal(77, kRows);
  signal(0) += position(0);
  signal.tail(kRows - 1) += position.head(kRows - 1);
  return signal;
}

std::vector<MeasuredSticking> found_in(const MatrixXd& commands, const MatrixXd& aux) {
  Recording recording = test::recording_of(commands, MatrixXd::Zero(kRows, 1));
  recording.aux = aux;
  return measured_sticking(recording);
}

MatrixXd commands() {
  MatrixXd both(kRows, 2);
  both << command(5), command(6);
  return both;
}

}  // namespace

TEST_CASE("a measured position shows how its valve sticks, and whose it is") {
  MatrixXd both = commands();
  for (const double jump : {0.2, 0.45}) {
    MatrixXd aux(kRows, 2);
    aux << test::normal(9, kRows), measured(sticking(both.col(1), kBand, jump), 0.03);
    both(400, 1) = aux(700, 1) = std::numeric_limits<double>::quiet_NaN();
    const std::vector<MeasuredSticking> found = found_in(both, aux);
    CAPTURE(jump);
    REQUIRE(found.size() == 1);
    CHECK(found[0].input == 1);
    CHECK(found[0].aux == 1);
    CHECK(found[0].valve.band == Approx(kBand).epsilon(0.1));
    CHECK(found[0].valve.jump == Approx(jump).margin(0.1));
    CHECK(found[0].valve.slips_once);
  }
}

TEST_CASE("what does as told, or something of its own, shows no sticking") {
  const MatrixXd both = commands();
  const VectorXd told = both.col(0);
  VectorXd slow = told;  // a loop below: a third of the way each sample
  for (Index k = 1; k < kRows; ++k) slow(k) = slow(k - 1) + (told(k) - slow(k - 1)) / 3.0;
  const VectorXd coarse = ((told.array() / 0.1).round() * 0.1).matrix();
  for (const VectorXd& position :
       {told, slow, coarse, VectorXd(test::autoregressive(test::normal(8, kRows), 0.97)),
        VectorXd(VectorXd::Constant(kRows, 40.0))})
    for (const double noise : {0.0, 0.03, 0.3})
      CHECK(found_in(both, measured(position, noise)).empty());
}

TEST_CASE("few rows, or none, show nothing") {
  CHECK(measured_sticking(test::recording_of(MatrixXd::Zero(0, 1), MatrixXd::Zero(0, 1))).empty());
  const VectorXd u = command(5).head(40);
  Recording recording = test::recording_of(u, MatrixXd::Zero(40, 1));
  recording.aux = sticking(u, kBand, 0.2);
  CHECK(measured_sticking(recording).empty());
}

}  // namespace mpm::measured_sticking_test
