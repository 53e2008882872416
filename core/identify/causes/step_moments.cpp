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

std::vector<Index> step_moments(const CvData& data, const CvFit& fit, const StepForm& form,
                                std::size_t most) {
  const VectorXd slope = misfit_slope(data, fit);
  const Index rows = slope.size();
  // The step is stays^j, less coming^j where it goes through a lag.
  const bool lagged = form.time_constant > 0.0;
  const double stays = form.decay > 0.0 ? std::exp(-1.0 / form.decay) : 1.0;
  const double coming = lagged ? stays * std::exp(-1.0 / form.time_constant) : 0.0;
  const VectorXd& a = fit.noise.coefficients;

  // Squares of the whitened step, summed over the rows since its onset.
  VectorXd step(rows);
  for (Index k = 0; k < rows; ++k)
    step(k) = std::pow(stays, static_cast<double>(k)) -
              (lagged ? std::pow(coming, static_cast<double>(k)) : 0.0);
  VectorXd squares = VectorXd::Zero(rows + 1);
  for (Index k = 0; k < rows; ++k) {
    double whitened = step(k);
    for (Index l = 1; l <= a.size() && l <= k; ++l) whitened -= a(l - 1) * step(k - l);
    squares(k + 1) = squares(k) + whitened * whitened / fit.variance;
  }

  VectorXd gain = VectorXd::Zero(rows);
  double plain = 0.0, missing = 0.0;  // sums with stays^j and with coming^j, from the end
  for (Index k = rows - 1; k >= 0; --k) {
    plain = slope(k) + stays * plain;
    missing = lagged ? slope(k) + coming * missing : 0.0;
    const double norm = squares(rows - k);
    if (k >= kStepMomentsMargin && k + kStepMomentsMargin < rows && norm > 0.0)
      gain(k) = (plain - missing) * (plain - missing) / norm;
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
