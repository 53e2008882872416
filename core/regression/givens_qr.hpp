#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/regression/rotation.hpp"
#include "core/regression/row_batch.hpp"

namespace mpm {

class Archive;

/// Recursive least squares in orthogonal form: the triangular factor of [X | Y], updated by one
/// row at a time with exponential forgetting.
///
/// Let row k be [x(k)' | y(k)'] with `columns` regressors and `responses` right-hand sides. After
/// each update the factor satisfies
///
///     [R Z]' [R Z] + [0 0; 0 S] = sum_l lambda^(k-l) [x(l)' y(l)']' [x(l)' y(l)'] ,
///
/// R upper triangular (columns x columns), Z = columns x responses. The row is rotated into R from
/// the first column to the last, in the square-root-free form (Gentleman 1973; Golub and Van Loan
/// 2013, 5.1.9 and 6.5.3): R = D^1/2 Rbar with Rbar of unit diagonal, the row carries a weight w,
///
///     d' = lambda d + w x_i^2,  s = w x_i / d',  x' = x - x_i rbar,  rbar' = rbar + s x',
///     w' = w lambda d / d' ,
///
/// (rbar' = (lambda d / d') rbar + s x where little of rbar is kept: the first form would cancel),
/// so that forgetting costs nothing and a rotation four flops per entry. What is left of the row's
/// responses, y - (its fit), is orthogonal to all regressors so far. The diagonal of S (the
/// residual sums of squares) and its first row (residual products of response 0 with each other
/// one) are accumulated from what is left, never by subtraction.
///
/// Rank: a column that the earlier ones explain to within rounding gets a diagonal entry of
/// exactly 0 and takes no part; nothing is divided by it. Put the intercept first, so that all
/// later columns are centred.
///
/// No allocation after construction. Cost per row: 4 flops for each of
/// columns^2 / 2 + columns * responses entries.
class GivensQr {
 public:
  /// Both > 0.
  GivensQr(int columns, int responses);

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int responses() const { return responses_; }

  /// Where the caller writes the next row, columns() regressors followed by responses() values,
  /// all finite. `update` consumes it.
  [[nodiscard]] double* row() { return own_.row(0); }

  /// Takes the row into the factor; everything before is weighted by lambda (0 < lambda <= 1).
  void update(double lambda) { update_batch(own_, 1, lambda); }

  /// Takes the first `count` rows of a batch, one after the other, with the bits of as many
  /// updates; consumes them. A stored row is loaded once for all of them.
  void update_batch(RowBatch& batch, int count, double lambda);

  /// The two parts of `update_batch`, for rows of which another factor has eliminated columns
  /// before. `rotate_batch` eliminates these ones: `weights` (one per row) is what the rows have
  /// left, and becomes what is then left of the responses; `magnitudes` (`stride` from row to row)
  /// the largest values that the columns had at first, as of each row.
  void rotate_batch(RowBatch& batch, int count, double lambda, double* weights,
                    const double* magnitudes, std::size_t stride);
  [[nodiscard]] const double* left(const RowBatch& batch, int k) const {
    return batch.row(k) + columns_;
  }
  void accumulate_batch(const RowBatch& batch, int count, double lambda, const double* weights);

  /// What the rows so far say of one that was not taken: its response 0 minus their prediction, and
  /// by how much the prediction's own uncertainty adds to that error's variance,
  /// x' (R' R)^-1 x >= 0; infinite in a direction never seen.
  struct Preview {
    double error = 0.0;
    double leverage = 0.0;
  };
  /// Of each of the first `count` rows of a batch, by itself; consumes them.
  void preview_batch(RowBatch& batch, int count, Preview* previews) const;

  /// Multiplies all that was taken so far by `factor` (> 0), as if each row had come scaled.
  void scale(double factor);
  void clear();

  [[nodiscard]] double r(int i, int j) const { return root(i) * *entry(i, j); }
  [[nodiscard]] double z(int i, int response) const {
    return root(i) * *entry(i, columns_ + response);
  }
  /// r and z without the row's factor root(i): r(i, j) = root(i) * unit_r(i, j).
  [[nodiscard]] double root(int i) const {
    return std::sqrt(weights_[static_cast<std::size_t>(i)]);
  }
  [[nodiscard]] double unit_r(int i, int j) const { return *entry(i, j); }
  /// unit_r(i, i), unit_r(i, i + 1), ...
  [[nodiscard]] const double* unit_row(int i) const { return entry(i, i); }
  /// Residual sum of squares of a response.
  [[nodiscard]] double residual_square(int response) const {
    return squares_[static_cast<std::size_t>(response)];
  }
  /// Sum of products of the residuals of response 0 and of `response`.
  [[nodiscard]] double residual_product(int response) const {
    return products_[static_cast<std::size_t>(response)];
  }
  /// Residual sums of squares and of products of all responses, contiguous.
  [[nodiscard]] const double* residual_squares() const { return squares_.data(); }
  [[nodiscard]] const double* residual_products() const { return products_.data(); }

  /// Root of the weighted sum of squares of column j after the intercept (column 0) is projected
  /// off: the scale against which its diagonal entry is judged.
  [[nodiscard]] double centred_norm(int j) const;
  /// The same of the columns from `first` (>= 1) on, as many as `norms` has.
  void centred_norms(int first, Eigen::Ref<Eigen::VectorXd> norms) const;

  /// Least-squares coefficients of one response into `coefficients` (`leading` long). Columns
  /// whose diagonal is at most negligible against their largest entry are left out (coefficient 0).
  /// With `leading` < columns(), of the regression on the first `leading` columns only.
  void solve(int response, int leading, Eigen::Ref<Eigen::VectorXd> coefficients) const;

  /// The factor; what nobody reads of its rows is not part of it.
  void archive(Archive& a);

 private:
  /// Row i is stored from the granule that holds column i on.
  [[nodiscard]] static std::size_t row_begin(int i) {
    return static_cast<std::size_t>(i) / kRowGranule * kRowGranule;
  }
  [[nodiscard]] const double* entry(int i, int j) const {
    return factor_.get() + offsets_[static_cast<std::size_t>(i)] + static_cast<std::size_t>(j) -
           row_begin(i);
  }

  void eliminate_batch(RowBatch& batch, int count, double lambda, const double* magnitudes,
                       std::size_t stride);
  void eliminate_column(int column, RowBatch& batch, int count, double lambda,
                        const double* magnitudes, std::size_t stride);
  void accumulate(double lambda, double left_weight, const double* left);

  int columns_;
  int responses_;
  std::size_t width_;                 // columns + responses, rounded up to whole granules
  std::vector<std::size_t> offsets_;  // of each stored row in factor_
  std::size_t factor_size_ = 0;
  AlignedArray factor_;
  RowBatch own_;
  std::vector<double> weights_;     // D, the squared diagonal of R
  std::vector<double> magnitudes_;  // per column, largest |x| seen, forgotten with sqrt(lambda)
  std::vector<double> squares_;
  std::vector<double> products_;
};

}  // namespace mpm
