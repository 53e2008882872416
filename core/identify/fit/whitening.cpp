#include "core/identify/fit/whitening.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd Whitening::apply(const Eigen::Ref<const VectorXd>& x) const {
  const Index order = coefficients.size(), rows = x.size();
  VectorXd result = x;
  for (Index l = 1; l <= order && l < rows; ++l)
    result.tail(rows - l) -= coefficients(l - 1) * x.head(rows - l);
  result.head(std::min(order, rows)).setZero();
  for (const Border& border : borders)
    result.segment(border.row, std::min(order, rows - border.row)).setZero();
  return result;
}

Whitening fit_whitening(const Eigen::Ref<const VectorXd>& residual,
                        const Eigen::Ref<const VectorXd>& weights, const NoiseModel& model) {
  const int order = model.order;
  const Index rows = residual.size() - order;
  Whitening whitening;
  whitening.coefficients.setZero(order);
  const double scale = residual.norm() / std::sqrt(static_cast<double>(std::max<Index>(1, rows)));
  if (rows <= 2 * order || !(scale > 0.0)) return whitening;
  Eigen::MatrixXd past(rows, order);
  const VectorXd root = weights.tail(rows).cwiseSqrt() / scale;
  for (Index l = 1; l <= order; ++l)
    past.col(l - 1) = residual.segment(order - l, rows).cwiseProduct(root);
  const VectorXd now = residual.tail(rows).cwiseProduct(root);
  whitening.coefficients = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(past).solve(now);
  if (model.bound > 0.0)
    whitening.coefficients = whitening.coefficients.cwiseMax(0.0).cwiseMin(model.bound);
  return whitening;
}

}  // namespace mpm
