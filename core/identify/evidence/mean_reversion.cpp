#include "core/identify/evidence/mean_reversion.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/identify/evidence/calibration.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index kBlocks = 100, kFewestBlocks = 30;
constexpr Index kLags = 2;  ///< earlier changes beside the level
/// 5 % point of the statistic with a constant, 100 values (Fuller 1976, table 8.5.2).
constexpr double kCritical = -2.89;

/// Means of the finite values of equal blocks; blocks without any are left out.
std::vector<double> block_means(const Eigen::Ref<const VectorXd>& signal) {
  const Index length = std::max<Index>(1, signal.size() / kBlocks);
  std::vector<double> means;
  for (Index first = 0; first + length <= signal.size(); first += length) {
    double sum = 0.0, count = 0.0;
    for (Index k = first; k < first + length; ++k)
      if (std::isfinite(signal(k))) sum += signal(k), count += 1.0;
    if (count > 0.0) means.push_back(sum / count);
  }
  return means;
}

}  // namespace

bool wanders(const Eigen::Ref<const VectorXd>& signal, double slowest_rows) {
  return static_cast<double>(signal.size()) > kLongTimeConstants * slowest_rows &&
         !comes_back(signal);
}

bool comes_back(const Eigen::Ref<const VectorXd>& signal) {
  const std::vector<double> levels = block_means(signal);
  const auto count = static_cast<Index>(levels.size());
  if (count < kFewestBlocks) return false;
  const VectorXd level = VectorXd::Map(levels.data(), count);
  const VectorXd change = level.tail(count - 1) - level.head(count - 1);
  const Index rows = count - 1 - kLags;
  MatrixXd columns(rows, 2 + kLags);
  columns.col(0).setOnes();
  columns.col(1) = level.segment(kLags, rows);
  for (Index lag = 1; lag <= kLags; ++lag) columns.col(1 + lag) = change.segment(kLags - lag, rows);
  const VectorXd right = change.tail(rows);
  const Eigen::ColPivHouseholderQR<MatrixXd> factor(columns);
  if (factor.rank() < columns.cols()) return true;  // stands still
  const VectorXd beta = factor.solve(right);
  const double variance =
      (right - columns * beta).squaredNorm() / static_cast<double>(rows - columns.cols());
  // |R'^-1 e|^2 is the variance of that coefficient for noise of variance 1.
  VectorXd unit = VectorXd::Zero(columns.cols());
  unit(1) = 1.0;
  const VectorXd permuted = factor.colsPermutation().transpose() * unit;
  const VectorXd half = factor.matrixR()
                            .topRows(columns.cols())
                            .triangularView<Eigen::Upper>()
                            .transpose()
                            .solve(permuted);
  return beta(1) < kCritical * std::sqrt(variance * half.squaredNorm());
}

}  // namespace mpm
