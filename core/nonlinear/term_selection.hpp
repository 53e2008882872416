#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/regression/givens_qr.hpp"

namespace mpm {

/// The last columns of a factor, taken in by groups: with R and z the part of the factor that
/// belongs to them, a group with columns R_g explains |Q'z|^2 of the response beyond the columns
/// before and the groups taken in so far, Q an orthonormal basis of what these leave of R_g. By
/// modified Gram-Schmidt (Bjorck 1996, section 2.4): what is taken in is projected off all other
/// columns at once, so that a group costs little to ask about. Columns that others explain to
/// within rounding take no part. No allocation after construction.
class TermSelection {
 public:
  /// Of factors with `count` columns (>= 1) behind `first` others.
  TermSelection(int first, int count);

  /// Begins anew with none taken in. `rotated`: count values, z.
  void read(const GivensQr& factor, const Eigen::Ref<const Eigen::VectorXd>& rotated);

  /// Sum of squares, and columns that take part.
  struct Gain {
    double square = 0.0;
    int columns = 0;
  };
  /// What these columns (0 <= column < count) would explain beyond what is taken in.
  [[nodiscard]] Gain gain(const std::vector<int>& columns);
  /// The same, and takes them in.
  Gain take(const std::vector<int>& columns);
  /// What all columns explain together. Before any is taken in.
  [[nodiscard]] Gain all() const;
  /// Of a column what is left by those before it and those taken in: its norm; 0 where that is
  /// rounding.
  [[nodiscard]] double norm_left(int column) const;

 private:
  [[nodiscard]] int orthogonalise(const std::vector<int>& columns);

  int first_, count_;
  Eigen::MatrixXd columns_;  // what is left of each
  Eigen::VectorXd rest_;     // of z
  Eigen::VectorXd scales_;   // of the columns as they were
  Eigen::MatrixXd basis_;    // of those asked about last
};

}  // namespace mpm
