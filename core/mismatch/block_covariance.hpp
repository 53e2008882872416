#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/mismatch/input_estimates.hpp"
#include "core/regression/row_batch.hpp"

namespace mpm {

/// Covariance of one input's scaled coefficients, for residuals of variance 1, as its triangular
/// factor S: S S' = T_i T_i', T_i the block's rows of T (`InputEstimates`). S comes from reflecting
/// what T_i has behind the block into the block's own triangle; the covariance is never formed.
/// No allocation after construction.
class BlockCovariance {
 public:
  explicit BlockCovariance(const InputEstimates& estimates);

  void read(const InputEstimates& estimates, int input);
  /// From a factor whose columns from `first` on are the block's, all others before them: S is the
  /// inverse of its last triangle.
  void read(const GivensQr& factor, int first);

  /// x <- S^-1 x: noise of the estimates becomes white.
  void whiten(Eigen::Ref<Eigen::VectorXd> x) const;
  /// x <- S'^-1 x
  void whiten_transposed(Eigen::Ref<Eigen::VectorXd> x) const;
  /// |S' x|^2, the variance of x' times the coefficients.
  [[nodiscard]] double variance_of(const Eigen::VectorXd& x) const;

 private:
  void reflect(int row, std::size_t stride);

  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  int block_;
  RowMajor factor_;             // S, upper triangular
  AlignedArray behind_;         // of T_i, columns behind the block; then their reflectors
  std::vector<double> shares_;  // of the rows above in a reflector
};

}  // namespace mpm
