#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mismatch/correlation_kind.hpp"
#include "core/regression/leave_one_out_qr.hpp"
#include "core/signal/lag_window.hpp"

namespace mpm {

class Archive;

/// Recursive correlations of all inputs, CVs and lags at once (Carlsson 2010, 3.4 and 3.14-3.17):
///
///     c_ji(d) = ParCorr(u_i(t), e_j(t+d) | 1, controls of input i),
///
/// the controls by CorrelationKind; lagged partial correlation unless told otherwise. The thesis
/// writes lag d as u_i(k-d) against e_j(k) with controls at k-d, ...; with t = k - d the controls
/// depend neither on j nor on d, so that one factor per input serves every CV and lag, and the
/// inputs' factors share most of the work (LeaveOneOutQr): its lead-in is what all inputs are
/// controlled for, its blocks what only the others are. All rows end at t = now - last_lag, for
/// every lag alike. Rows are weighted lambda^age. No allocation after construction.
class LaggedCorrelation {
 public:
  struct Shape {
    int inputs = 1;            ///< m >= 1
    int cvs = 1;               ///< n >= 1
    int controlling_lags = 0;  ///< g >= 0; without meaning for kPartial and kConventional
    int first_lag = 0;
    int last_lag = 0;  ///< >= max(first_lag, 0)
    CorrelationKind kind = CorrelationKind::kLaggedPartial;
  };

  /// `lambda` in (0, 1]. Throws std::invalid_argument on an impossible shape.
  LaggedCorrelation(const Shape& shape, double lambda);

  /// Takes u(k) (m values) and e(k) (n values), all finite, of the next interval.
  void update(const Eigen::Ref<const Eigen::VectorXd>& inputs,
              const Eigen::Ref<const Eigen::VectorXd>& residuals);
  /// The intervals so far and the next one are not neighbours: no row may span both.
  void close_window() { filled_ = 0; }

  /// Refreshes all correlations from the factors.
  void evaluate();
  /// Correlations of one channel for lags first_lag..last_lag, after `evaluate`. Where the input
  /// does not move by itself (silent, or an exact combination of the others), or too few rows
  /// came, they are 0 and `defined` is false.
  [[nodiscard]] Eigen::Ref<const Eigen::VectorXd> correlations(int cv, int input) const {
    return correlations_.col(input * shape_.cvs + cv);
  }
  [[nodiscard]] bool defined(int input) const { return defined_[static_cast<std::size_t>(input)]; }
  [[nodiscard]] int inputs() const { return shape_.inputs; }
  [[nodiscard]] int cvs() const { return shape_.cvs; }
  [[nodiscard]] int lag_count() const { return shape_.last_lag - shape_.first_lag + 1; }

  void archive(Archive& a);

 private:
  [[nodiscard]] bool conventional() const { return shape_.kind == CorrelationKind::kConventional; }
  [[nodiscard]] const double* past(int input) const {  // u_i(t), u_i(t-1), ...
    return input_windows_[static_cast<std::size_t>(input)].window() + shape_.last_lag;
  }
  double* fill_inputs(double* out) const;

  Shape shape_;
  double lambda_;
  int block_columns_;
  int window_rows_;  // intervals a row spans
  int filled_ = 0;   // neighbouring intervals so far, at most window_rows_
  bool has_origin_ = false;
  Eigen::VectorXd origin_;  // of the inputs: their first values
  std::vector<LagWindow> input_windows_;
  std::vector<LagWindow> residual_windows_;
  // One tree with a block per input; kConventional: for each input a tree that knows no other.
  // Responses: e_j, lags newest first.
  std::vector<LeaveOneOutQr> factors_;
  std::vector<double> totals_;    // per input, weighted sum of squares about its origin
  Eigen::MatrixXd correlations_;  // lags x (inputs * cvs)
  std::vector<bool> defined_;
};

}  // namespace mpm
