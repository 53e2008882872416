#include "core/identify/fit/triangle.hpp"

#include <algorithm>
#include <cmath>

#include "core/regression/rotation.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

constexpr Index kRowsAtOnce = 256;  // whole granules of `reflect`

}  // namespace

// Rows come in blocks that stay in the cache, each reflected into the triangle of those before
// (Householder; Golub and Van Loan 2013, 5.2). A column that is zero in a block costs nothing
// there: a level or first state of a run has nothing to say of the others' rows.
MatrixXd triangle(const MatrixXd& matrix) {
  const Index columns = matrix.cols();
  MatrixXd transposed = MatrixXd::Zero(columns, columns);  // each row of the triangle as a column
  MatrixXd block(kRowsAtOnce, columns);
  for (Index first = 0; first < matrix.rows(); first += kRowsAtOnce) {
    const Index rows = std::min(kRowsAtOnce, matrix.rows() - first);
    block.topRows(rows) = matrix.middleRows(first, rows);
    block.bottomRows(kRowsAtOnce - rows).setZero();
    for (Index j = 0; j < columns; ++j) {
      const double below = block.col(j).squaredNorm();
      if (below == 0.0) continue;  // not where it is no number
      const double top = transposed(j, j);
      const double diagonal = std::copysign(std::sqrt(top * top + below), -top);
      block.col(j) /= top - diagonal;
      transposed(j, j) = diagonal;
      const auto right = static_cast<int>(columns - j - 1);
      if (right == 0) continue;
      reflect(block.col(j).data(), {block.col(j + 1).data(), kRowsAtOnce, right}, kRowsAtOnce,
              (diagonal - top) / diagonal, &transposed(j + 1, j));
    }
  }
  return transposed.transpose().topRows(std::min(columns, matrix.rows()));
}

}  // namespace mpm
