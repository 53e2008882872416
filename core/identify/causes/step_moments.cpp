#include "core/identify/causes/step_moments.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/identify/fit/misfit_slope.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr Index kStepMomentsMargin = 5;  ///< rows at either end
constexpr Index kStepMomentsApart = 4;   ///< rows

}  // namespace

std::vector<Index> step_moments(const CvData& data, const CvFit& fit, double time_constant,
                                std::size_t most) {
  const VectorXd slope = misfit_slope(data, fit);
  const Index rows = slope.size();
  const double pole = time_constant > 0.0 ? std::exp(-1.0 / time_constant) : 0.0;
  const VectorXd& a = fit.noise.coefficients;

  // Squares of the whitened step, summed over the rows since its onset.
  VectorXd step(rows);
  for (Index k = 0; k < rows; ++k)
    step(k) = time_constant > 0.0 ? 1.0 - std::pow(pole, static_cast<double>(k)) : 1.0;
  VectorXd squares = VectorXd::Zero(rows + 1);
  for (Index k = 0; k < rows; ++k) {
    double whitened = step(k);
    for (Index l = 1; l <= a.size() && l <= k; ++l) whitened -= a(l - 1) * step(k - l);
    squares(k + 1) = squares(k) + whitened * whitened / fit.variance;
  }

  VectorXd gain = VectorXd::Zero(rows);
  double plain = 0.0, lagged = 0.0;  // sums with 1 and with pole^j, from the end
  for (Index k = rows - 1; k >= 0; --k) {
    plain += slope(k);
    lagged = time_constant > 0.0 ? slope(k) + pole * lagged : 0.0;
    const double norm = squares(rows - k);
    if (k >= kStepMomentsMargin && k + kStepMomentsMargin < rows && norm > 0.0)
      gain(k) = (plain - lagged) * (plain - lagged) / norm;
  }
  std::vector<Index> order(static_cast<std::size_t>(rows));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index x, Index y) { return gain(x) > gain(y); });
  std::vector<Index> best;
  for (const Index k : order) {
    if (best.size() == most || !(gain(k) > 0.0)) break;
    const bool near = std::any_of(best.begin(), best.end(), [&](Index other) {
      return std::abs(other - k) < kStepMomentsApart;
    });
    if (!near) best.push_back(k);
  }
  return best;
}

}  // namespace mpm
