#include "core/statistics/f_distribution.hpp"

#include <cmath>
#include <limits>

namespace mpm {
namespace {

// Continued fraction of I_x(a, b) without its front factor; converges fast for x < (a+1)/(a+b+2).
double beta_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  double c = 1.0;
  double d = 1.0 - (a + b) * x / (a + 1.0);
  d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
  double fraction = d;
  for (int n = 1; n < 10000; ++n) {
    const double even = n * (b - n) * x / ((a + 2.0 * n - 1.0) * (a + 2.0 * n));
    d = 1.0 + even * d;
    d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
    c = 1.0 + even / c;
    c = std::abs(c) < kTiny ? kTiny : c;
    fraction *= c * d;
    const double odd = -(a + n) * (a + b + n) * x / ((a + 2.0 * n) * (a + 2.0 * n + 1.0));
    d = 1.0 + odd * d;
    d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
    c = 1.0 + odd / c;
    c = std::abs(c) < kTiny ? kTiny : c;
    const double step = c * d;
    fraction *= step;
    if (std::abs(step - 1.0) < 2.0 * kEpsilon) break;
  }
  return fraction;
}

// log of Gamma without the global sign that std::lgamma writes.
double log_gamma(double x) {
  int sign = 0;
  return lgamma_r(x, &sign);
}

// I_x(a, b), with y = 1 - x given so that neither end loses digits.
double incomplete_beta(double a, double b, double x, double y) {
  if (x <= 0.0) return 0.0;
  if (y <= 0.0) return 1.0;
  const double front =
      std::exp(a * std::log(x) + b * std::log(y) + log_gamma(a + b) - log_gamma(a) - log_gamma(b));
  if (x < (a + 1.0) / (a + b + 2.0)) return front * beta_fraction(a, b, x) / a;
  return 1.0 - front * beta_fraction(b, a, y) / b;
}

}  // namespace

double f_upper_tail(double statistic, double numerator, double denominator) {
  if (!(statistic > 0.0)) return 1.0;
  const double sum = denominator + numerator * statistic;
  return incomplete_beta(0.5 * denominator, 0.5 * numerator, denominator / sum,
                         numerator * statistic / sum);
}

double f_quantile(double probability, double numerator, double denominator) {
  double low = 0.0;
  double high = 1.0;
  while (f_upper_tail(high, numerator, denominator) > probability && high < 1e300) {
    low = high;
    high *= 2.0;
  }
  while (high - low > 1e-10 * high) {
    const double middle = 0.5 * (low + high);
    (f_upper_tail(middle, numerator, denominator) > probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace mpm
