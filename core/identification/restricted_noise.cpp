#include "core/identification/restricted_noise.hpp"

#include <Eigen/QR>
#include <cmath>

#include "core/identification/calibration.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// X R^-1 where X = Q R; columns that depend on others become zero.
MatrixXd behind(const MatrixXd& columns, const MatrixXd& factor) {
  MatrixXd result = columns;
  for (Index c = 0; c < result.cols(); ++c) {
    for (Index before = 0; before < c; ++before)
      result.col(c) -= factor(before, c) * result.col(before);
    const bool dependent = std::abs(factor(c, c)) <= kDependent * factor.col(c).norm();
    result.col(c) *= dependent ? 0.0 : 1.0 / factor(c, c);
  }
  return result;
}

MatrixXd factor_of(const MatrixXd& columns) {
  if (columns.cols() == 0) return MatrixXd(0, 0);
  return Eigen::HouseholderQR<MatrixXd>(columns)
      .matrixQR()
      .topRows(columns.cols())
      .triangularView<Eigen::Upper>();
}

/// Adds sum over the columns of white(k) plain(k - lag), for each lag.
void add_products(const Eigen::Ref<const MatrixXd>& white, const MatrixXd& plain,
                  VectorXd& products) {
  for (Index lag = 1; lag <= products.size() && lag < plain.rows(); ++lag) {
    const Index rows = plain.rows() - lag;
    products(lag - 1) += white.bottomRows(rows).cwiseProduct(plain.topRows(rows)).sum();
  }
}

/// Half of how the log determinant falls with each coefficient.
VectorXd slopes_of_determinant(const std::vector<FittedColumns>& runs, Index order) {
  VectorXd slopes = VectorXd::Zero(order);
  const Index shared = runs.front().shared.cols();
  std::vector<MatrixXd> plain, white;
  MatrixXd factor(0, shared);
  for (const FittedColumns& run : runs) {
    const Index rows = run.own.rows();
    if (run.own_white.rows() < run.own.cols()) continue;
    const MatrixXd own_factor = factor_of(run.own_white);
    const MatrixXd own = behind(run.own, own_factor);
    const MatrixXd own_white = behind(run.own_white, own_factor);
    add_products(own_white.topRows(rows), own, slopes);
    if (shared == 0) continue;
    const MatrixXd part = own_white.topRows(rows).transpose() * run.shared_white;
    plain.emplace_back(run.shared - own * part);
    white.emplace_back(-own_white * part);
    white.back().topRows(rows) += run.shared_white;
    MatrixXd both(factor.rows() + white.back().rows(), shared);
    both << factor, white.back();
    factor = both.rows() > shared ? factor_of(both) : both;
  }
  if (shared == 0 || factor.rows() < shared) return slopes;
  for (std::size_t r = 0; r < plain.size(); ++r)
    add_products(behind(white[r], factor).topRows(plain[r].rows()), behind(plain[r], factor),
                 slopes);
  return slopes;
}

}  // namespace

Whitening restricted_noise(const std::vector<FittedColumns>& runs,
                           const Eigen::Ref<const VectorXd>& residual,
                           const Eigen::Ref<const VectorXd>& weights, const Whitening& noise,
                           double variance) {
  const Index order = noise.coefficients.size(), rows = residual.size() - order;
  Whitening restricted = noise;
  if (order == 0 || rows <= 2 * order || !(variance > 0.0)) return restricted;
  MatrixXd past(rows, order);
  const VectorXd root = weights.tail(rows).cwiseSqrt();
  for (Index lag = 1; lag <= order; ++lag)
    past.col(lag - 1) = residual.segment(order - lag, rows).cwiseProduct(root);
  const MatrixXd factor = factor_of(past / std::sqrt(variance));
  if (factor.diagonal().cwiseAbs().minCoeff() <= kDependent * factor.norm()) return restricted;
  const VectorXd slopes = slopes_of_determinant(runs, order);
  restricted.coefficients += factor.triangularView<Eigen::Upper>().solve(
      factor.transpose().triangularView<Eigen::Lower>().solve(slopes));
  return restricted;
}

}  // namespace mpm
