#include "core/identify/causes/measured_force.hpp"

#include <catch2/catch.hpp>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::measured_force_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 2000;
constexpr double kGain = 2.0, kLag = 10.0, kQuadratic = 0.1, kCubic = 0.02;

/// y(k+1) = p y(k) + K (1 - p) (u(k) - phi(y(k))), p = e^{-1/T}, as far as it goes.
VectorXd bent(const VectorXd& u, double quadratic, double cubic) {
  const double pole = std::exp(-1.0 / kLag);
  VectorXd y = VectorXd::Zero(u.size());
  for (Index k = 0; k + 1 < u.size(); ++k)
    y(k + 1) = pole * y(k) +
               kGain * (1.0 - pole) * (u(k) - quadratic * y(k) * y(k) - cubic * y(k) * y(k) * y(k));
  return y;
}

/// Of a CV that another input moves as well, under noise that wanders a little.
Eigen::Vector2d force(double quadratic, double cubic, std::uint64_t seed) {
  Eigen::MatrixXd inputs(kRows, 2);
  inputs << test::telegraph(seed, kRows, 12), test::telegraph(10 + seed, kRows, 9);
  const VectorXd y = bent(inputs.col(0), quadratic, cubic) +
                     test::first_order(inputs.col(1), 1.0, 5.0) +
                     0.005 * test::autoregressive(test::normal(20 + seed, kRows), 0.9);
  const Recording recording = test::recording_of(inputs, y);
  const ModelSpec model = test::model_of({lag(0, 0, kGain, kLag), lag(0, 1, 1.0, 5.0)}, 2, 1);
  Problem problem(model, 2, recording, Tolerances{}, NoiseModel{});
  const std::vector<CvFit> without = problem.fit({}, 0, {0}).cvs;
  return measured_force({problem, {}, without}, model.channels[0]);
}

TEST_CASE("the force on a measured CV is near the true one, and none where there is none") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    const Eigen::Vector2d found = force(kQuadratic, kCubic, seed);
    CHECK(found(0) == Approx(kQuadratic).epsilon(0.1));
    CHECK(found(1) == Approx(kCubic).epsilon(0.2));
    const Eigen::Vector2d none = force(0.0, 0.0, seed);
    CHECK(std::abs(none(0)) < 0.1 * kQuadratic);
    CHECK(std::abs(none(1)) < 0.2 * kCubic);
  }
}

}  // namespace
}  // namespace mpm::measured_force_test
