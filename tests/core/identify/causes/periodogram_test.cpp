#include "core/identify/causes/periodogram.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::periodogram_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd sine(Index rows, double size, double cycles, double phase = 0.3) {
  return VectorXd::NullaryExpr(rows, [&](Index k) {
    return size * std::sin(2.0 * M_PI * cycles * static_cast<double>(k) / double(rows) + phase);
  });
}

// The sum by its definition, term by term.
TEST_CASE("the power at an angle is that of the Fourier sum") {
  const VectorXd values = test::white(1, 257).array() + 0.4;
  for (const double angle : {0.0, 1e-3, 0.1, 1.0, 2.0, 3.0, M_PI}) {
    CAPTURE(angle);
    std::complex<double> sum = 0.0;
    for (Index k = 0; k < values.size(); ++k)
      sum += values(k) * std::polar(1.0, -angle * static_cast<double>(k));
    CHECK(power_at(values, angle) == Approx(std::norm(sum)).epsilon(1e-9).margin(1e-9));
  }
  CHECK(power_at(VectorXd(), 1.0) == 0.0);
}

// Over whole cycles a sine of size A sums to A n / 2 at its own frequency and to nothing at others.
TEST_CASE("a sine has its power at its own frequency") {
  const VectorXd values = sine(400, 3.0, 12.0);
  CHECK(power_at(values, 2.0 * M_PI * 12.0 / 400.0) == Approx(std::pow(3.0 * 200.0, 2)));
  CHECK(power_at(values, 2.0 * M_PI * 13.0 / 400.0) == Approx(0.0).margin(1e-6));
}

TEST_CASE("the loudest cycles come first, within what is asked for") {
  const VectorXd values =
      sine(400, 1.0, 5.0) + sine(400, 3.0, 17.0) + sine(400, 2.0, 40.0) + sine(400, 9.0, 2.0);
  CHECK(loudest_cycles(values, 3, 60, 3) == std::vector<int>{17, 40, 5});
  CHECK(loudest_cycles(values, 3, 60, 1) == std::vector<int>{17});
  CHECK(loudest_cycles(values, 3, 40, 2) == std::vector<int>{17, 5});  // 40 is not below 40
  CHECK(loudest_cycles(values, 2, 60, 1) == std::vector<int>{2});
  CHECK(loudest_cycles(values, 3, 5, 9).size() == 2);
  CHECK(loudest_cycles(values, 5, 5, 9).empty());
}

}  // namespace
}  // namespace mpm::periodogram_test
