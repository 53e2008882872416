#pragma once

#include <Eigen/Core>

namespace mpm {

/// Columns of a matrix of a channel's whitened error directions.
namespace error_column {
inline constexpr int kGain = 0;     ///< of 100 %
inline constexpr int kTime = 1;     ///< of the logarithm of the time constants
inline constexpr int kLater = 2;    ///< of the dead time, one sample more
inline constexpr int kEarlier = 3;  ///< one sample less
inline constexpr int kCount = 4;
}  // namespace error_column

/// Three directions, of gain, time constants and a shift, as an orthonormal basis times r, and what
/// they say of a target: |target - columns x|^2 = rest_square + |c - r x|^2. A direction that the
/// ones before it span has a zero diagonal and takes no part.
struct ReducedErrors {
  Eigen::Matrix3d r = Eigen::Matrix3d::Zero();
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  double rest_square = 0.0;

  /// min |c - r x| with x(2) >= 0: where the free minimum has it negative, it is 0.
  [[nodiscard]] Eigen::Vector3d fit() const;
  /// S.d. of x for unit noise; infinite in directions that take no part.
  [[nodiscard]] Eigen::Vector3d deviations() const;
  /// S.d. of weights' x for unit noise, of directions that take part.
  [[nodiscard]] double deviation_of(const Eigen::Vector3d& weights) const;
};

/// Makes them; no allocation after construction.
class ErrorReduction {
 public:
  /// `rows`: of the longest target.
  explicit ErrorReduction(int rows);
  /// `columns`: rows of the target x error_column::kCount; `shift`: kLater or kEarlier.
  [[nodiscard]] ReducedErrors reduce(const Eigen::Ref<const Eigen::VectorXd>& target,
                                     const Eigen::Ref<const Eigen::MatrixXd>& columns, int shift);

 private:
  Eigen::MatrixXd basis_;
};

}  // namespace mpm
