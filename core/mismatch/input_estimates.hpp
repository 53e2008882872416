#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "core/mismatch/regression_history.hpp"
#include "core/regression/givens_qr.hpp"

namespace mpm {

/// What one CV's factor says of the coefficients of all inputs' columns, each column scaled to norm
/// 1: with R_t their trailing triangle and z the rotated responses, T = R_t^-1 and the estimate
/// T z. The factor is never squared. Columns without movement have norm 0 and estimate 0. No
/// allocation after construction.
class InputEstimates {
 public:
  explicit InputEstimates(const RegressionShape& shape);

  void read(int cv, const GivensQr& factor);

  [[nodiscard]] int inputs() const { return shape_.inputs; }
  /// Columns of one input.
  [[nodiscard]] int block() const { return block_; }
  /// Columns of all inputs, and the same rounded up to whole granules.
  [[nodiscard]] int columns() const { return static_cast<int>(norms_.size()); }
  [[nodiscard]] int padded() const { return padded_; }

  /// Whether all of the input's columns moved.
  [[nodiscard]] bool moved(int input) const { return norms(input).minCoeff() > 0.0; }
  /// Of an input's columns: their norms, the reciprocals of these, and the scaled coefficients.
  [[nodiscard]] Eigen::Ref<const Eigen::VectorXd> norms(int input) const {
    return norms_.segment(input * block_, block_);
  }
  [[nodiscard]] Eigen::Ref<const Eigen::VectorXd> scales(int input) const {
    return scales_.segment(input * block_, block_);
  }
  [[nodiscard]] Eigen::Ref<const Eigen::VectorXd> estimate(int input) const {
    return estimate_.segment(input * block_, block_);
  }
  /// z, of all columns.
  [[nodiscard]] const Eigen::VectorXd& rotated() const { return rotated_; }
  /// Row i of R_t, of an input's columns: `block` values.
  void triangle_row(int i, int input, double* out) const {
    Eigen::Map<Eigen::RowVectorXd>(out, block_) = triangle_.row(i).segment(input * block_, block_);
  }
  /// Row i of T from column 0 on, `padded` values; zero before column i.
  [[nodiscard]] const double* inverse_row(int i) const {
    return inverse_.get() + static_cast<std::size_t>(i) * static_cast<std::size_t>(padded_);
  }
  /// R_t x for scaled coefficients x of one input, into the first `columns` values of `out` up to
  /// the end of its block; behind it all is zero.
  void move(int input, const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> out) const;
  /// |R_t x|^2: what they would move, were the other inputs known not to matter. `work`: `columns`
  /// values.
  [[nodiscard]] double movement(int input, const Eigen::VectorXd& x, Eigen::VectorXd& work) const;

  /// For how many rows an input remembers where it was: 1 / (1 - the correlation of its last two
  /// values), all but the inputs taken out. 1: not at all.
  [[nodiscard]] double memory(int input) const;

  /// a_1..a_p and those of the means, of the CV's own residual, of the regression on everything
  /// where everything can be told apart, otherwise of the one on the residual lags alone: a loop
  /// without excitation makes inputs a function of residuals.
  [[nodiscard]] const Eigen::VectorXd& own_past() const { return own_past_; }
  /// Until the next `read`.
  void set_own_past(const Eigen::VectorXd& past) { own_past_ = past; }
  /// Of the CV's own last residual.
  [[nodiscard]] double residual_norm() const { return residual_norm_; }

 private:
  [[nodiscard]] double* inverse_row(int i) {
    return inverse_.get() + static_cast<std::size_t>(i) * static_cast<std::size_t>(padded_);
  }
  void read_own_past(int cv, const GivensQr& factor);
  void invert_triangle();
  void subtract_rows_behind(int first);
  void invert_granule(int first);

  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  RegressionShape shape_;
  int block_;
  int lead_in_ = 0;  // of the factor that was read
  int padded_;
  RowMajor triangle_;             // R_t, columns scaled to norm 1; padded with zeros
  AlignedArray inverse_;          // T, likewise
  Eigen::VectorXd norms_;         // of the columns
  Eigen::VectorXd scales_;        // 1 / norms_
  Eigen::VectorXd rotated_;       // z
  Eigen::VectorXd estimate_;      // T z
  Eigen::VectorXd coefficients_;  // of the whole regression
  Eigen::VectorXd own_past_;
  double residual_norm_ = 0.0;
};

}  // namespace mpm
