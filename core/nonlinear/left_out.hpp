#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/regression/givens_qr.hpp"

namespace mpm {

/// What the last columns of a factor say, and what is lost where some of them are left out: with R
/// and z the part of the factor that belongs to them, b = R^-1 z their coefficients and M the rows
/// of R^-1 that belong to the ones left out,
///
///     lost = b' (M M')^-1 b,
///
/// by orthogonalising M's rows. Columns that the ones before explain to within rounding take no
/// part. No allocation after construction.
class LeftOut {
 public:
  /// Of factors with `count` columns (>= 1) behind `first` others.
  LeftOut(int first, int count);

  /// `rotated`: count values, z.
  void read(const GivensQr& factor, const Eigen::Ref<const Eigen::VectorXd>& rotated);
  /// Sum of squares that all of them explain together.
  [[nodiscard]] double explained() const { return rotated_.squaredNorm(); }
  [[nodiscard]] bool live(int column) const { return live_[static_cast<std::size_t>(column)]; }
  /// Sum of squares that is lost without these columns (0 <= column < count), and how many of them
  /// take part.
  struct Loss {
    double square = 0.0;
    int columns = 0;
  };
  [[nodiscard]] Loss loss(const std::vector<int>& columns);
  /// The same had the coefficients been found as `value` for `column`, which is among them, and 0.
  [[nodiscard]] double loss_of(const std::vector<int>& columns, int column, double value);

 private:
  [[nodiscard]] int gather(const std::vector<int>& columns);
  [[nodiscard]] double orthogonalise(int count);

  int first_, count_;
  Eigen::MatrixXd inverse_;  // of the triangle, transposed: column c is row c of R^-1
  Eigen::VectorXd rotated_;
  Eigen::VectorXd coefficients_;
  Eigen::VectorXd scales_;
  std::vector<bool> live_;
  Eigen::MatrixXd kept_;
  Eigen::VectorXd right_;
};

}  // namespace mpm
