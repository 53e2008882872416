#include "core/identification/cross_noise.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/identification/calibration.hpp"
#include "core/identification/high_order.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// All CVs on the past of all, lag by lag, and of the inputs.
struct JointRegression {
  int lags = 0;
  std::vector<LagBlock> blocks;
  std::vector<Index> rows;  // of the data: all CVs known there and at all lags
  MatrixXd regressors;      // rows x columns: a level for each run, CVs (CV by CV), inputs
  MatrixXd triangle;        // R of the regressors
  MatrixXd right;           // columns x CVs: the CVs, rotated alike
  MatrixXd inverse;         // of R
  MatrixXd coefficients;    // columns x CVs
  MatrixXd covariance;      // of the CVs' e
  double freedom = 0.0;
  Index levels = 0;

  [[nodiscard]] Index first_lag_of(Index cv) const { return levels + cv * lags; }
};

/// Nothing where the rows do not suffice.
std::optional<JointRegression> joint_regression(const IdentificationData& data) {
  JointRegression joint;
  const Index cvs = data.cvs.cols(), inputs = data.inputs.cols();
  joint.levels = static_cast<Index>(data.runs.size());
  joint.lags = kCrossLags;
  Index columns = 0;
  for (int longest = longest_lag(data);; longest /= 2) {
    if (longest < kCrossLags) return std::nullopt;
    joint.blocks = lag_blocks(longest);
    columns = joint.first_lag_of(cvs) + inputs * static_cast<Index>(joint.blocks.size());
    joint.rows =
        rows_with_past(data.runs, data.known.rowwise().minCoeff(), joint.lags, longest / 4);
    if (static_cast<double>(joint.rows.size()) >=
        kCrossRowsPerColumn * static_cast<double>(columns))
      break;
  }
  const auto count = static_cast<Index>(joint.rows.size());
  joint.regressors = MatrixXd::Zero(count, columns);
  MatrixXd known(count, cvs);
  Index run = 0;
  for (Index r = 0; r < count; ++r) {
    const Index k = joint.rows[static_cast<std::size_t>(r)];
    while (run + 1 < joint.levels && data.runs[static_cast<std::size_t>(run) + 1].first <= k) ++run;
    joint.regressors(r, run) = 1.0;
    for (Index j = 0; j < cvs; ++j)
      for (int l = 1; l <= joint.lags; ++l)
        joint.regressors(r, joint.first_lag_of(j) + l - 1) = data.cvs(k - l, j);
    known.row(r) = data.cvs.row(k);
  }
  for (Index i = 0; i < inputs; ++i) {
    const MatrixXd sums = lagged_sums(data.inputs.col(i), joint.blocks, data.runs);
    for (Index r = 0; r < count; ++r)
      joint.regressors.row(r).segment(joint.first_lag_of(cvs) + i * sums.cols(), sums.cols()) =
          sums.row(joint.rows[static_cast<std::size_t>(r)]);
  }
  // What the other columns explain, an input that stands still, is held where it is.
  MatrixXd system = MatrixXd::Zero(count + columns, columns + cvs);
  system.topLeftCorner(count, columns) = joint.regressors;
  system.topRightCorner(count, cvs) = known;
  const VectorXd sizes = joint.regressors.colwise().norm();
  for (Index c = 0; c < columns; ++c)
    system(count + c, c) = sizes(c) > 0.0 ? kDependent * sizes(c) : 1.0;
  const Eigen::HouseholderQR<MatrixXd> qr(system);
  const MatrixXd all = qr.matrixQR().topRows(columns + cvs).triangularView<Eigen::Upper>();
  joint.triangle = all.topLeftCorner(columns, columns);
  joint.right = all.topRightCorner(columns, cvs);
  joint.freedom = static_cast<double>(count - columns);
  joint.inverse =
      joint.triangle.triangularView<Eigen::Upper>().solve(MatrixXd::Identity(columns, columns));
  joint.coefficients = joint.inverse * joint.right;
  const MatrixXd left = all.bottomRightCorner(cvs, cvs);
  joint.covariance = left.transpose() * left / joint.freedom;
  return joint;
}

/// Of CV i (row): whether the past of CV j (column) says more of it than chance does.
Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> followed(const JointRegression& joint) {
  const Index cvs = joint.right.cols();
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> follows(cvs, cvs);
  follows.setConstant(false);
  for (Index j = 0; j < cvs; ++j) {
    const Index first = joint.first_lag_of(j);
    // Covariance of the lags' coefficients: T T', and T' = Q S.
    const Eigen::HouseholderQR<MatrixXd> qr(
        joint.inverse.middleRows(first, joint.lags).transpose());
    const MatrixXd s = qr.matrixQR().topRows(joint.lags).triangularView<Eigen::Upper>();
    const MatrixXd white = s.transpose().triangularView<Eigen::Lower>().solve(
        joint.coefficients.middleRows(first, joint.lags));
    for (Index i = 0; i < cvs; ++i) {
      const double statistic = white.col(i).squaredNorm() / (joint.lags * joint.covariance(i, i));
      follows(i, j) = i == j || f_upper_tail(statistic, joint.lags, joint.freedom) < kCrossPValue;
    }
  }
  return follows;
}

/// Coefficients of one CV's regression without the lags of CVs that it does not follow.
VectorXd coefficients_of(const JointRegression& joint, Index cv,
                         const Eigen::Matrix<bool, Eigen::Dynamic, 1>& follows) {
  std::vector<Index> kept;
  for (Index c = 0; c < joint.triangle.cols(); ++c) {
    const Index of = c < joint.levels ? -1 : (c - joint.levels) / joint.lags;
    if (of < 0 || of >= follows.size() || follows(of)) kept.push_back(c);
  }
  MatrixXd system(joint.triangle.rows(), static_cast<Index>(kept.size()));
  for (std::size_t c = 0; c < kept.size(); ++c)
    system.col(static_cast<Index>(c)) = joint.triangle.col(kept[c]);
  const VectorXd found = Eigen::HouseholderQR<MatrixXd>(system).solve(joint.right.col(cv));
  VectorXd coefficients = VectorXd::Zero(joint.triangle.cols());
  for (std::size_t c = 0; c < kept.size(); ++c)
    coefficients(kept[c]) = found(static_cast<Index>(c));
  return coefficients;
}

/// Of the steady gains (I - A(1))^-1 B(1): of one from u to CV j, d = m (dA(1) g + dB(1)), m row j
/// of the inverse and g the gains from u.
MatrixXd gain_sd_of(const JointRegression& joint, Index inputs) {
  const Index cvs = joint.right.cols(), columns = joint.triangle.cols();
  const auto blocks = static_cast<Index>(joint.blocks.size());
  MatrixXd past = MatrixXd::Zero(cvs, columns), moves = MatrixXd::Zero(inputs, columns);
  for (Index j = 0; j < cvs; ++j) past.row(j).segment(joint.first_lag_of(j), joint.lags).setOnes();
  for (Index i = 0; i < inputs; ++i)
    for (Index b = 0; b < blocks; ++b) {
      const LagBlock& block = joint.blocks[static_cast<std::size_t>(b)];
      moves(i, joint.first_lag_of(cvs) + i * blocks + b) = block.last - block.first + 1;
    }
  const MatrixXd rest = MatrixXd::Identity(cvs, cvs) - (past * joint.coefficients).transpose();
  const MatrixXd settled = Eigen::FullPivHouseholderQR<MatrixXd>(rest).inverse();
  const MatrixXd gains = settled * (moves * joint.coefficients).transpose();
  MatrixXd sd(cvs, inputs);
  for (Index i = 0; i < inputs; ++i) {
    const VectorXd weights = past.transpose() * gains.col(i) + moves.row(i).transpose();
    const double size = (joint.inverse.transpose() * weights).norm();
    for (Index j = 0; j < cvs; ++j)
      sd(j, i) = size * std::sqrt(settled.row(j).dot(settled.row(j) * joint.covariance));
  }
  return sd;
}

}  // namespace

CrossNoise cross_noise(const IdentificationData& data) {
  const Index cvs = data.cvs.cols();
  CrossNoise result{MatrixXd::Zero(data.samples(), cvs), MatrixXd::Zero(cvs, data.inputs.cols())};
  MatrixXd& brought = result.brought;
  if (cvs < 2) return result;
  const std::optional<JointRegression> joint = joint_regression(data);
  if (!joint) return result;
  const auto follows = followed(*joint);
  if (follows.count() == cvs) return result;
  const MatrixXd gain_sd = gain_sd_of(*joint, data.inputs.cols());
  MatrixXd coefficients(joint->triangle.cols(), cvs);
  for (Index i = 0; i < cvs; ++i)
    coefficients.col(i) = coefficients_of(*joint, i, follows.row(i).transpose());
  MatrixXd errors = MatrixXd::Zero(data.samples(), cvs);
  const MatrixXd fitted = joint->regressors * coefficients;
  for (std::size_t r = 0; r < joint->rows.size(); ++r)
    errors.row(joint->rows[r]) = data.cvs.row(joint->rows[r]) - fitted.row(static_cast<Index>(r));
  MatrixXd disturbance = errors;  // v
  for (const auto& [first, count] : data.runs)
    for (Index k = first; k < first + count; ++k)
      for (Index i = 0; i < cvs; ++i)
        for (Index j = 0; j < cvs; ++j)
          for (int l = 1; l <= joint->lags && k - l >= first && follows(i, j); ++l) {
            const double share = coefficients(joint->first_lag_of(j) + l - 1, i);
            disturbance(k, i) += share * disturbance(k - l, j);
            brought(k, i) += share * (i == j ? brought(k - l, i) : disturbance(k - l, j));
          }
  for (Index i = 0; i < cvs; ++i) {
    const VectorXd known = data.known.col(i);
    const double most = kMostBrought * spread_of(data.cvs.col(i), known);
    if (!disturbance.allFinite() || !brought.col(i).allFinite() ||
        !(brought.col(i).cwiseAbs().maxCoeff() < most) ||
        !(disturbance.col(i).cwiseAbs().maxCoeff() < most) ||
        spread_of(brought.col(i), known) < kLeastBrought * spread_of(disturbance.col(i), known)) {
      brought.col(i).setZero();
      continue;
    }
    brought.col(i).array() -= brought.col(i).dot(known) / std::max(1.0, known.sum());
    brought.col(i) = brought.col(i).cwiseProduct(known);
    if (follows.row(i).count() > 1) result.gain_sd.row(i) = gain_sd.row(i);
  }
  return result;
}

}  // namespace mpm
