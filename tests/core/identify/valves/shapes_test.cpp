#include "core/identify/valves/shapes.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kHalf = 40;  // samples

/// Of a place 0..1 in the half cycle.
template <class Shape>
VectorXd half_of(Shape shape) {
  return VectorXd::NullaryExpr(kHalf + 1, [&](Index k) {
    return shape(static_cast<double>(k) / static_cast<double>(kHalf));
  });
}

VectorXd triangle(double peak) {
  return half_of([&](double x) { return x < peak ? x / peak : (1.0 - x) / (1.0 - peak); });
}

VectorXd half_sine() {
  return half_of([](double x) { return std::sin(M_PI * x); });
}

/// Two quarter sines of different lengths.
VectorXd skewed(double peak) { return (0.5 * M_PI * triangle(peak)).array().sin(); }

/// A first order lag from 0 towards 1, and after two time constants towards -1 until 0 again.
VectorXd relay_response() {
  const double top = 1.0 - std::exp(-2.0);
  const double length = 2.0 + std::log(1.0 + top);  // -1 + (1 + top) exp(-t) = 0
  return half_of([&](double x) {
    const double t = x * length;
    return t < 2.0 ? 1.0 - std::exp(-t) : -1.0 + (1.0 + top) * std::exp(2.0 - t);
  });
}

const std::vector<HalfCycle> kOne = {{0.0, static_cast<double>(kHalf)}};

/// Jumps of 1, up and down by turns, in front of the rows `first`, `first` + `step` ..
VectorXd jumping(Index first, Index step) {
  VectorXd values = VectorXd::Zero(401);
  for (Index k = first; k < values.size(); k += step)
    values.tail(values.size() - k).array() = 1.0 - values(k);
  return values;
}

}  // namespace

// One of the two errors is 0.
TEST_CASE("the triangle index of straight lines is 1, that of round ones 0") {
  for (const double peak : {0.2, 0.5, 0.7}) {
    CHECK(triangle_index(triangle(peak), kOne) == Approx(1.0).margin(1e-6));
    CHECK(triangle_index(-3.0 * triangle(peak), kOne) == Approx(1.0).margin(1e-6));
    CHECK(triangle_index(skewed(peak), kOne) == Approx(0.0).margin(1e-6));
  }
}

// What a sine leaves of a triangle a triangle leaves of a sine: both 1 - cos^2 of their angle.
TEST_CASE("a triangle and a sine together are undecided") {
  VectorXd swing(2 * kHalf + 1);
  swing << triangle(0.5), -half_sine().tail(kHalf);
  const std::vector<HalfCycle> two = {{0.0, 40.0}, {40.0, 80.0}};
  CHECK(triangle_index(swing, two) == Approx(0.5).margin(1e-6));
}

TEST_CASE("the relay index of a lag behind a relay is 1, that of a sine -1") {
  CHECK(relay_index(relay_response(), kOne) == Approx(1.0).margin(1e-6));
  CHECK(relay_index(-3.0 * relay_response(), kOne) == Approx(1.0).margin(1e-6));
  CHECK(relay_index(half_sine(), kOne) == Approx(-1.0).margin(1e-6));
  CHECK(relay_index(triangle(0.5), kOne) > 0.21);  // of a long lag, as good as sticking
}

TEST_CASE("without a half cycle of five samples there is no shape") {
  const VectorXd swing = half_sine();
  for (const std::vector<HalfCycle>& none :
       std::vector<std::vector<HalfCycle>>{{}, {{0.5, 4.5}}, {{-2.0, 30.0}}, {{20.0, 60.0}}}) {
    CHECK(std::isnan(triangle_index(swing, none)));
    CHECK(std::isnan(relay_index(swing, none)));
  }
}

TEST_CASE("resting is the share of the moves that the value does not follow") {
  // 40 jumps of the output in 400 rows, of which the value follows 10; then 10 of its own as well.
  const VectorXd output = jumping(10, 10), value = jumping(10, 40);
  CHECK(resting_index(output, value, 10.0) == Approx(30.0 / 40.0));
  CHECK(resting_index(output, value + jumping(15, 40), 10.0) == Approx(30.0 / 50.0));
  CHECK(resting_index(output, output, 10.0) == 0.0);
  CHECK(resting_index(value, output, 10.0) == 0.0);
}

TEST_CASE("where nothing moves, or not for a tenth of a period, nothing rests") {
  const VectorXd constant = VectorXd::Ones(100);
  CHECK(std::isnan(resting_index(constant, constant, 10.0)));
  const VectorXd output = jumping(5, 10).head(20);
  CHECK(std::isnan(resting_index(output, output, 200.0)));
}

}  // namespace mpm
