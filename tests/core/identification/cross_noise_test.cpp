#include "core/identification/cross_noise.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "core/identification/identification.hpp"
#include "tests/core/identification/loop.hpp"

namespace mpm::test::cross_noise_test {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr Index kRows = 2500;

/// Two CVs and two MVs, all lags 10 samples, gains 2, 1, 1, 2, under integral control that knows
/// them. One load moves the first CV and, two samples later, the second; or each has its own.
Recording loop(std::uint64_t seed, bool one_load) {
  Matrix2d gain;
  gain << 2.0, 1.0, 1.0, 2.0;
  const Matrix2d moves = 0.12 * gain.inverse();
  const VectorXd first = autoregressive(normal(8 * seed, kRows), 0.95);
  const VectorXd other = autoregressive(normal(8 * seed + 1, kRows), 0.95);
  const VectorXd late =
      one_load ? VectorXd(first.head(kRows - 2)) : VectorXd(other.head(kRows - 2));
  MatrixXd loads = MatrixXd::Zero(kRows, 2);
  loads.col(0) = 0.3 * first;
  loads.col(1).tail(kRows - 2) = 0.3 * late;
  MatrixXd setpoints(kRows, 2), u = MatrixXd::Zero(kRows, 2), y = MatrixXd::Zero(kRows, 2);
  setpoints << telegraph(8 * seed + 2, kRows, 45), telegraph(8 * seed + 3, kRows, 60);
  const MatrixXd noise = [&] {
    MatrixXd values(kRows, 2);
    values << normal(8 * seed + 4, kRows), normal(8 * seed + 5, kRows);
    return values;
  }();
  const double pole = std::exp(-0.1);
  Vector2d x = Vector2d::Zero(), command = Vector2d::Zero();
  for (Index k = 0; k < kRows; ++k) {
    y.row(k) = x.transpose() + 0.05 * noise.row(k);
    command += moves * (setpoints.row(k) - y.row(k)).transpose();
    u.row(k) = command.transpose();
    x = pole * x + (1.0 - pole) * (gain * command + 2.0 * loads.row(k).transpose());
  }
  return recording_of(u, y);
}

}  // namespace

TEST_CASE("what disturbs each CV by itself brings nothing to the others") {
  // Two F tests at 1e-4 each: false in 1 of 250 tries of 20.
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const CrossNoise found = cross_noise(identification_data(loop(900 + seed, false)));
    CHECK(found.brought.isZero());
    CHECK(found.gain_sd.isZero());
  }
}

TEST_CASE("what one load does to a CV later is told from what it did to another") {
  const IdentificationData data = identification_data(loop(930, true));
  const CrossNoise found = cross_noise(data);
  CHECK(found.brought.col(1).norm() > 0.2 * std::sqrt(static_cast<double>(kRows)));
  CHECK((found.gain_sd.row(1).array() > 0.0).all());
  CHECK(std::abs(found.brought.col(1).mean()) < 1e-9);
}

// Under feedback a fit that knows but its own CV's past takes part of the controller for the plant:
// the gain of 2 came out as 1.4 on average, and 11 of 12 intervals missed it. The second CV's own
// channel, over 12 loops.
TEST_CASE("a gain under feedback holds where one load moves all CVs", "[trials]") {
  double sum = 0.0, fitted = 0.0;
  int missed = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Identification found = identify(loop(940 + seed, true), {});
    const ChannelAnswer& answer = answer_of(found, 1, 1);
    if (!answer.dynamics) continue;
    fitted += 1.0;
    sum += answer.dynamics->gain;
    missed += answer.gain.low < 2.0 && 2.0 < answer.gain.high ? 0 : 1;
  }
  CHECK(fitted >= 10.0);
  CHECK(sum / fitted == Approx(2.0).epsilon(0.2));
  CHECK(missed <= 3);  // of 12 at 95 %: more in 1 of 400 tries
}

}  // namespace mpm::test::cross_noise_test
