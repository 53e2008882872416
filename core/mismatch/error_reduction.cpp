#include "core/mismatch/error_reduction.hpp"

#include <algorithm>
#include <limits>

#include "core/mismatch/calibration.hpp"

namespace mpm {

Eigen::Vector3d ReducedErrors::fit() const {
  Eigen::Vector3d x(0.0, 0.0, r(2, 2) > 0.0 ? std::max(c(2) / r(2, 2), 0.0) : 0.0);
  for (int i = 1; i >= 0; --i)
    if (r(i, i) > 0.0) x(i) = (c(i) - r.row(i).tail(2 - i).dot(x.tail(2 - i))) / r(i, i);
  return x;
}

// Norms of the rows of r^-1.
Eigen::Vector3d ReducedErrors::deviations() const {
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  for (int column = 0; column < 3; ++column) {
    if (r(column, column) == 0.0) continue;
    inverse(column, column) = 1.0 / r(column, column);
    for (int i = column - 1; i >= 0; --i) {
      if (r(i, i) == 0.0) continue;
      double sum = 0.0;
      for (int k = i + 1; k <= column; ++k) sum += r(i, k) * inverse(k, column);
      inverse(i, column) = -sum / r(i, i);
    }
  }
  Eigen::Vector3d norms = inverse.rowwise().norm();
  for (int i = 0; i < 3; ++i)
    if (r(i, i) == 0.0) norms(i) = std::numeric_limits<double>::infinity();
  return norms;
}

// |r'^-1 weights|
double ReducedErrors::deviation_of(const Eigen::Vector3d& weights) const {
  Eigen::Vector3d solved = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i)
    if (r(i, i) != 0.0) solved(i) = (weights(i) - r.col(i).head(i).dot(solved.head(i))) / r(i, i);
  return solved.norm();
}

ErrorReduction::ErrorReduction(int rows) : basis_(Eigen::MatrixXd::Zero(rows, 3)) {}

// [gain, time, shift] = Q R by Gram-Schmidt, twice each (Kahan; Parlett 1980), and Q' of the
// target.
ReducedErrors ErrorReduction::reduce(const Eigen::Ref<const Eigen::VectorXd>& target,
                                     const Eigen::Ref<const Eigen::MatrixXd>& columns, int shift) {
  const Eigen::Index rows = target.size();
  ReducedErrors reduced;
  reduced.rest_square = target.squaredNorm();
  int column = 0;
  for (const int direction : {error_column::kGain, error_column::kTime, shift}) {
    auto q = basis_.col(column).head(rows);
    q = columns.col(direction);
    const double before = q.norm();
    for (int pass = 0; pass < 2; ++pass)
      for (int b = 0; b < column; ++b) {
        const double share = basis_.col(b).head(rows).dot(q);
        reduced.r(b, column) += share;
        q -= share * basis_.col(b).head(rows);
      }
    const double own = q.norm();
    if (own > calibration::rounding::kIndependentShare * before) {
      reduced.r(column, column) = own;
      q /= own;
      reduced.c(column) = q.dot(target);
      reduced.rest_square -= reduced.c(column) * reduced.c(column);
    } else {
      q.setZero();
    }
    ++column;
  }
  reduced.rest_square = std::max(reduced.rest_square, 0.0);
  return reduced;
}

}  // namespace mpm
