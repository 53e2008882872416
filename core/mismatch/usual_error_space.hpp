#pragma once

#include <Eigen/Core>

namespace mpm {

/// The directions that a channel's usual errors take among its whitened coefficients, as an
/// orthonormal basis Q. No allocation after construction.
class UsualErrorSpace {
 public:
  /// `block`: coefficients of a channel.
  explicit UsualErrorSpace(int block);

  void clear() { rank_ = 0; }
  /// Takes in one error more, unless those before span it; overwrites it.
  void add(Eigen::VectorXd& error);

  /// Columns of Q.
  [[nodiscard]] int rank() const { return rank_; }
  /// |Q' x|^2
  [[nodiscard]] double explained(const Eigen::VectorXd& x) const;
  /// The same of the first error alone.
  [[nodiscard]] double explained_by_first(const Eigen::VectorXd& x) const {
    const double part = basis_.col(0).dot(x);
    return part * part;
  }
  /// Q' x into the first `rank` values of `out`.
  void coordinates(const Eigen::Ref<const Eigen::VectorXd>& x,
                   Eigen::Ref<Eigen::VectorXd> out) const;

 private:
  Eigen::MatrixXd basis_;
  int rank_ = 0;
};

}  // namespace mpm
