#include "core/identify/fit/mean_reversion.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <vector>

#include "core/identify/fit/calibration.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index kBlocks = 100, kFewestBlocks = 30;
constexpr Index kLags = 2;  ///< earlier changes beside the level
/// 5 % point of the statistic with a constant, 100 values (Fuller 1976, table 8.5.2).
constexpr double kCritical = -2.89;
/// Points of the statistic without earlier changes, of walks that were drawn: 0.1 % where nothing
/// was let break (400 000 walks; the 1 % point is -3.50, Fuller's 1976 is -3.51); 1 % where level
/// and slope were once, twice, or more often, where that leaves least (300 walks). (Zivot and
/// Andrews 1992 have more negative ones for the break that speaks most for coming back.)
constexpr double kCriticalBesideBreaks[] = {-4.22, -4.84, -5.73, -6.46};

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

/// How many of its s.d. the coefficient of the level is below zero, beside a constant and so many
/// earlier changes; null where there are too few rows, minus infinity for what stands still.
std::optional<double> statistic(const Eigen::Ref<const VectorXd>& signal, Index lags) {
  const std::vector<double> levels = block_means(signal);
  const auto count = static_cast<Index>(levels.size());
  if (count < kFewestBlocks) return std::nullopt;
  const VectorXd level = VectorXd::Map(levels.data(), count);
  const VectorXd change = level.tail(count - 1) - level.head(count - 1);
  const Index rows = count - 1 - lags;
  MatrixXd columns(rows, 2 + lags);
  columns.col(0).setOnes();
  columns.col(1) = level.segment(lags, rows);
  for (Index lag = 1; lag <= lags; ++lag) columns.col(1 + lag) = change.segment(lags - lag, rows);
  const VectorXd right = change.tail(rows);
  const Eigen::ColPivHouseholderQR<MatrixXd> factor(columns);
  if (factor.rank() < columns.cols()) return -std::numeric_limits<double>::infinity();
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
  return beta(1) / std::sqrt(variance * half.squaredNorm());
}

}  // namespace

bool wanders(const Eigen::Ref<const VectorXd>& signal, double slowest_rows) {
  return static_cast<double>(signal.size()) > kLongTimeConstants * slowest_rows &&
         !comes_back(signal);
}

bool comes_back(const Eigen::Ref<const VectorXd>& signal) {
  return statistic(signal, kLags).value_or(0.0) < kCritical;
}

bool comes_back_beside_breaks(const Eigen::Ref<const VectorXd>& signal, std::size_t breaks) {
  return beyond_a_walk(signal, breaks) > 0.0;
}

double beyond_a_walk(const Eigen::Ref<const VectorXd>& signal, std::size_t breaks) {
  const double critical =
      kCriticalBesideBreaks[std::min(breaks, std::size(kCriticalBesideBreaks) - 1)];
  const double deviations = std::min(0.0, statistic(signal, 0).value_or(0.0));
  return deviations * deviations - critical * critical;
}

}  // namespace mpm
