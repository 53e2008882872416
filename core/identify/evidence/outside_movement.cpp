#include "core/identify/evidence/outside_movement.hpp"

#include <Eigen/QR>
#include <cmath>

#include "core/identify/evidence/calibration.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kStill = 1e-9;  ///< share of its level that is rounding, not movement
constexpr double kFewestKnown = 0.5;
constexpr double kRidge = 1e-3;  ///< s.d. of the signals that counts as rounding

/// Held where unknown, mean 0, s.d. 1; nothing where it stands still or is hardly known.
std::optional<VectorXd> scaled(const Eigen::Ref<const VectorXd>& signal) {
  VectorXd values = signal;
  double held = 0.0;
  bool begun = false;
  Index known = 0;
  for (Index k = 0; k < values.size(); ++k) {
    if (std::isfinite(values(k))) {
      if (!begun) values.head(k).setConstant(values(k));
      begun = true;
      held = values(k);
      ++known;
    } else if (begun) {
      values(k) = held;
    }
  }
  if (static_cast<double>(known) < kFewestKnown * static_cast<double>(values.size()))
    return std::nullopt;
  const double mean = values.mean();
  values.array() -= mean;
  const double sd = std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
  if (!(sd > kStill * std::abs(mean)) || !std::isfinite(sd)) return std::nullopt;
  return values / sd;
}

/// The joint autoregression of some signals.
class Autoregression {
 public:
  /// `signals`: samples x signals. Each is regressed on the last kMovementOrder rows of all and on
  /// those before it in its own row.
  explicit Autoregression(const MatrixXd& signals)
      : past_(signals.cols() * kMovementOrder), first_(kMovementOrder) {
    const Index rows = signals.rows() - first_, count = signals.cols();
    MatrixXd columns(rows, past_ + count);
    for (int lag = 1; lag <= kMovementOrder; ++lag)
      columns.middleCols((lag - 1) * count, count) = signals.middleRows(first_ - lag, rows);
    columns.rightCols(count) = signals.bottomRows(rows);
    innovations_ = MatrixXd::Zero(signals.rows(), count);
    for (Index s = 0; s < count; ++s) {
      // A controller without dynamics makes columns of each other: a ridge keeps the sum bounded.
      const Index width = past_ + s;
      MatrixXd system(rows + width, width);
      system.topRows(rows) = columns.leftCols(width);
      system.bottomRows(width).setZero();
      system.bottomRows(width).diagonal().setConstant(kRidge *
                                                      std::sqrt(static_cast<double>(rows)));
      VectorXd right = VectorXd::Zero(rows + width);
      right.head(rows) = columns.col(width);
      coefficients_.emplace_back(Eigen::HouseholderQR<MatrixXd>(system).solve(right));
      innovations_.col(s).tail(rows) =
          right.head(rows) - system.topRows(rows) * coefficients_.back();
    }
  }

  /// What the innovations of the signals first .. first + count - 1 alone make of all signals.
  [[nodiscard]] MatrixXd moved_by(Index first, Index count) const {
    const Index signals = innovations_.cols();
    MatrixXd result = MatrixXd::Zero(innovations_.rows(), signals);
    VectorXd row(past_ + signals);
    for (Index k = first_; k < result.rows(); ++k) {
      for (int lag = 1; lag <= kMovementOrder; ++lag)
        row.segment((lag - 1) * signals, signals) = result.row(k - lag);
      for (Index s = 0; s < signals; ++s) {
        double value = row.head(past_ + s).dot(coefficients_[static_cast<std::size_t>(s)]);
        if (s >= first && s < first + count) value += innovations_(k, s);
        row(past_ + s) = result(k, s) = value;
      }
    }
    return result;
  }

 private:
  Index past_, first_;
  std::vector<VectorXd> coefficients_;
  MatrixXd innovations_;
};

}  // namespace

std::vector<std::optional<double>> outside_shares(const Recording& recording,
                                                  const MatrixXd& residuals) {
  std::vector<std::optional<double>> shares(static_cast<std::size_t>(recording.inputs.cols()));
  const Index samples = recording.samples();
  MatrixXd signals(samples, residuals.cols() + recording.inputs.cols());
  Index count = 0;
  for (Index j = 0; j < residuals.cols(); ++j)
    if (const std::optional<VectorXd> signal = scaled(residuals.col(j)))
      signals.col(count++) = *signal;
  const Index cvs = count;
  std::vector<std::size_t> moving;
  for (Index i = 0; i < recording.inputs.cols(); ++i)
    if (const std::optional<VectorXd> signal = scaled(recording.inputs.col(i))) {
      signals.col(count++) = *signal;
      moving.push_back(static_cast<std::size_t>(i));
    }
  signals.conservativeResize(Eigen::NoChange, count);
  const double columns = static_cast<double>(count) * (kMovementOrder + 1);
  if (moving.empty() || static_cast<double>(samples) < kMovementRowsPerColumn * columns)
    return shares;
  const Autoregression joint(signals);
  const MatrixXd feedback = joint.moved_by(0, cvs), outside = joint.moved_by(cvs, count - cvs);
  for (std::size_t m = 0; m < moving.size(); ++m) {
    const auto col = cvs + static_cast<Index>(m);
    const double by_feedback = feedback.col(col).squaredNorm();
    const double from_outside = outside.col(col).squaredNorm();
    const double share = from_outside / (by_feedback + from_outside);
    if (std::isfinite(share)) shares[moving[m]] = share;
  }
  return shares;
}

}  // namespace mpm
