#include "core/nonlinear/polynomial_map.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <stdexcept>

namespace mpm {

TEST_CASE("monomials are products of powers") {
  const PolynomialMap one(1, {{2, 0}, {3, 0}});
  std::array<double, 2> features{};
  const double x = -1.5;
  one.apply(&x, features.data());
  CHECK(features == std::array{2.25, -3.375});

  const PolynomialMap two(2, {{1, 1}, {2, 1}});
  const std::array point = {3.0, -2.0};
  two.apply(point.data(), features.data());
  CHECK(features == std::array{-6.0, -18.0});
  CHECK_THROWS_AS(PolynomialMap(3, {{1, 1}}), std::invalid_argument);
}

}  // namespace mpm
