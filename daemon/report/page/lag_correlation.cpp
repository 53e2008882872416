#include "daemon/report/page/lag_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mpm::report {
namespace {

constexpr std::size_t kOrder = 20;
constexpr double kRidge = 1e-9;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
  std::size_t count = 0;
};

Moments moments(const std::vector<double>& values) {
  Moments result;
  for (const double value : values)
    if (std::isfinite(value)) {
      result.mean += value;
      ++result.count;
    }
  if (result.count == 0) return result;
  result.mean /= static_cast<double>(result.count);
  for (const double value : values)
    if (std::isfinite(value)) result.variance += (value - result.mean) * (value - result.mean);
  result.variance /= static_cast<double>(result.count);
  return result;
}

void centre(std::vector<double>& values) {
  const double mean = moments(values).mean;
  for (double& value : values) value -= mean;
}

/// Autoregressive coefficients by Levinson and Durbin: x(k) = sum a[i] x(k-1-i) + white.
std::vector<double> autoregression(const std::vector<double>& x, std::size_t order) {
  std::vector<double> r(order + 1, 0.0);
  for (std::size_t lag = 0; lag <= order; ++lag)
    for (std::size_t k = lag; k < x.size(); ++k)
      if (std::isfinite(x[k]) && std::isfinite(x[k - lag])) r[lag] += x[k] * x[k - lag];
  r[0] *= 1.0 + kRidge;
  std::vector<double> a, last;
  double error = r[0];
  for (std::size_t i = 0; i < order && error > 0.0; ++i) {
    double left = r[i + 1];
    for (std::size_t j = 0; j < i; ++j) left -= a[j] * r[i - j];
    const double reflection = left / error;
    last = a;
    for (std::size_t j = 0; j < i; ++j) a[j] -= reflection * last[i - 1 - j];
    a.push_back(reflection);
    error *= 1.0 - reflection * reflection;
  }
  return a;
}

/// x(k) - sum a[i] x(k-1-i); NaN where a part of it is.
std::vector<double> filtered(const std::vector<double>& x, const std::vector<double>& a) {
  std::vector<double> result(x.size(), kNaN);
  for (std::size_t k = a.size(); k < x.size(); ++k) {
    double value = x[k];
    for (std::size_t i = 0; i < a.size(); ++i) value -= a[i] * x[k - 1 - i];
    result[k] = value;
  }
  return result;
}

}  // namespace

LagCorrelation lag_correlation(const std::vector<double>& input,
                               const std::vector<double>& residual, int first_lag, int last_lag) {
  LagCorrelation result;
  result.first_lag = first_lag;
  std::vector<double> x = input, e = residual;
  centre(x);
  centre(e);
  const Moments movement = moments(x);
  if (movement.count < 4 * kOrder || !(movement.variance > 0.0)) return result;
  const std::vector<double> whitener = autoregression(x, kOrder);
  x = filtered(x, whitener);
  e = filtered(e, whitener);
  const double scale = std::sqrt(moments(x).variance * moments(e).variance);
  const std::size_t pairs = std::min(moments(x).count, moments(e).count);
  if (!(scale > 0.0) || pairs == 0) return result;
  result.bound = 2.0 / std::sqrt(static_cast<double>(pairs));
  const auto n = static_cast<std::ptrdiff_t>(x.size());
  for (std::ptrdiff_t lag = first_lag; lag <= last_lag; ++lag) {
    double sum = 0.0;
    double count = 0.0;
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, -lag); k < std::min(n, n - lag); ++k) {
      const double product = x[static_cast<std::size_t>(k)] * e[static_cast<std::size_t>(k + lag)];
      if (!std::isfinite(product)) continue;
      sum += product;
      count += 1.0;
    }
    result.values.push_back(count > 0.0 ? sum / (count * scale) : kNaN);
  }
  return result;
}

}  // namespace mpm::report
