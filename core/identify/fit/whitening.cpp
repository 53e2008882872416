#include "core/identify/fit/whitening.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/identify/fit/triangle.hpp"
#include "core/regression/rotation.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd Whitening::apply(const Eigen::Ref<const VectorXd>& x) const {
  const Index order = coefficients.size(), rows = x.size();
  VectorXd result(rows);
  result.head(std::min(order, rows)).setZero();
  subtract_past(x.data(), static_cast<std::size_t>(rows), coefficients.data(),
                static_cast<std::size_t>(order), result.data());
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
  const VectorXd root = weights.tail(rows).cwiseSqrt() / scale;
  Eigen::MatrixXd past_and_now(rows, order + 1);
  for (Index l = 1; l <= order; ++l)
    past_and_now.col(l - 1) = residual.segment(order - l, rows).cwiseProduct(root);
  past_and_now.col(order) = residual.tail(rows).cwiseProduct(root);
  // What pivots is the triangle: its columns are as long, and as much of one another's direction.
  const Eigen::MatrixXd r = triangle(past_and_now);
  whitening.coefficients =
      Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(r.topLeftCorner(order, order))
          .solve(r.col(order).head(order));
  if (model.bound > 0.0)
    whitening.coefficients = whitening.coefficients.cwiseMax(0.0).cwiseMin(model.bound);
  return whitening;
}

}  // namespace mpm
