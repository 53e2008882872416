#include "core/identify/fit/walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identify/fit/calibration.hpp"
#include "core/identify/fit/row_weights.hpp"
#include "core/identify/fit/triangle.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

VectorXd steps_of(const Eigen::Ref<const VectorXd>& x) {
  VectorXd steps = x;
  steps.tail(x.size() - 1) -= x.head(x.size() - 1);
  steps(0) = 0.0;
  return steps;
}

}  // namespace

VectorXd WalkSteps::rows_of(const Eigen::Ref<const VectorXd>& x) const {
  return noise.apply(steps_of(x)).cwiseProduct(weights.cwiseSqrt());
}

double WalkSteps::rows() const { return static_cast<double>((weights.array() > 0.0).count()); }

WalkSteps walk_steps(const CvData& data, const CvFit& fit,
                     const Eigen::Ref<const VectorXd>& wander) {
  WalkSteps steps;
  // A step is known where both its rows are.
  steps.weights = data.weights.cwiseProduct(rows_with_past(data.known, data.runs, kWalkOrder + 1));
  steps.noise = fit_whitening(steps_of(wander), steps.weights, {.order = kWalkOrder, .bound = 0.0});
  steps.noise.borders = fit.noise.borders;
  return steps;
}

VectorXd left_beside_a_walk(const CvData& data, const CvFit& fit) {
  const Index small = data.nuisances.cols() - static_cast<Index>(data.runs.size());
  const auto columns = data.nuisances.rightCols(small);
  const VectorXd off = (data.known.array() > 0.0).select(left_of(data, fit), 0.0);
  VectorXd left = off;
  for (int pass = 0; pass < kWalkPasses; ++pass) {
    const WalkSteps steps = walk_steps(data, fit, left);
    const double variance = steps.rows_of(left).squaredNorm() / std::max(1.0, steps.rows());
    const double sd = std::sqrt(std::max(kLeastVariance, variance));
    MatrixXd stacked(off.size() + small, small + 1);
    for (Index c = 0; c < small; ++c)
      stacked.col(c).head(off.size()) = steps.rows_of(columns.col(c).cwiseProduct(data.known)) / sd;
    stacked.col(small).head(off.size()) = steps.rows_of(off) / sd;
    stacked.bottomLeftCorner(small, small).setIdentity();
    stacked.bottomRightCorner(small, 1).setZero();
    const MatrixXd r = triangle(stacked);
    const VectorXd beta = r.topLeftCorner(small, small)
                              .triangularView<Eigen::Upper>()
                              .solve(r.col(small).head(small));
    left = (off - columns * beta).cwiseProduct(data.known);
  }
  return (data.known.array() > 0.0).select(left, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace mpm
