#include "core/statistics/f_distribution.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace mpm {
namespace {

TEST_CASE("upper tail of F agrees with its closed forms") {
  // F(2, d): (1 + 2x/d)^(-d/2). F(1, 1): 1 - 2/pi atan sqrt x. F(d, 2): 1 - (1 + 2/(d x))^(-d/2).
  for (const double d : {1.0, 7.5, 40.0, 2900.0}) {
    for (const double x : {1e-3, 0.5, 1.0, 3.0, 9.0, 60.0}) {
      CAPTURE(d, x);
      CHECK(f_upper_tail(x, 2.0, d) ==
            Approx(std::exp(-0.5 * d * std::log1p(2.0 * x / d))).epsilon(1e-10));
      CHECK(f_upper_tail(x, d, 2.0) ==
            Approx(-std::expm1(-0.5 * d * std::log1p(2.0 / (d * x)))).epsilon(1e-9));
    }
  }
  CHECK(f_upper_tail(3.0, 1.0, 1.0) == Approx(1.0 - 2.0 / M_PI * std::atan(std::sqrt(3.0))));
  CHECK(f_upper_tail(0.0, 3.0, 5.0) == 1.0);
  CHECK(f_upper_tail(-1.0, 3.0, 5.0) == 1.0);
}

// Even numerators n: with w = n x / (d + n x), P = (1 - w)^(d/2) sum_{k < n/2} G(d/2 + k) / (G(d/2)
// k!) w^k (the incomplete beta function of a whole argument, Abramowitz and Stegun 1964, 26.5.7).
double even_tail(double x, int n, double d) {
  const double w = n * x / (d + n * x);
  double term = 1.0, sum = 0.0;
  for (int k = 0; k < n / 2; ++k) {
    sum += term;
    term *= (0.5 * d + k) / (k + 1.0) * w;
  }
  return std::exp(0.5 * d * std::log1p(-w)) * sum;
}

TEST_CASE("upper tail of F far out") {
  for (const int n : {4, 22, 48})
    for (const double d : {120.5, 440.0, 2911.0})
      for (const double x : {0.7, 1.5, 4.0, 12.0, 25.0}) {
        CAPTURE(n, d, x);
        CHECK(f_upper_tail(x, n, d) == Approx(even_tail(x, n, d)).epsilon(1e-11));
      }
  CHECK(f_upper_tail(35.0, 48, 2911.0) == Approx(even_tail(35.0, 48, 2911.0)).epsilon(1e-11));
  CHECK(f_upper_tail(1e9, 22, 2911.0) < 1e-300);
  CHECK(f_upper_tail(std::numeric_limits<double>::infinity(), 22, 2911.0) == 0.0);
  CHECK(f_upper_tail(std::nan(""), 22, 2911.0) == 1.0);
}

TEST_CASE("F of the sizes used here agrees with printed tables") {
  // Percentage points of F, e.g. Pearson and Hartley, Biometrika Tables vol. 1, table 18.
  CHECK(f_quantile(0.05, 10.0, 20.0) == Approx(2.35).margin(0.005));
  CHECK(f_quantile(0.01, 10.0, 20.0) == Approx(3.37).margin(0.005));
  CHECK(f_quantile(0.01, 20.0, 120.0) == Approx(2.03).margin(0.005));
  CHECK(f_quantile(0.001, 20.0, 60.0) == Approx(2.83).margin(0.005));
}

TEST_CASE("the quantile inverts the tail") {
  for (const double p : {0.5, 1e-2, 1e-6, 1e-12})
    CHECK(f_upper_tail(f_quantile(p, 21.0, 2911.0), 21.0, 2911.0) == Approx(p).epsilon(1e-11));
}

}  // namespace
}  // namespace mpm
