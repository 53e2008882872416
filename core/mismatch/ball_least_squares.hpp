#pragma once

#include <Eigen/Core>
#include <Eigen/SVD>

namespace mpm {

/// min |c - M x|^2 over |x| <= radius, M square: by its singular values and the multiplier at which
/// |x| is the radius (Golub and Van Loan 2013, 6.2.1). No allocation after construction.
class BallLeastSquares {
 public:
  explicit BallLeastSquares(int size);
  [[nodiscard]] double distance_square(const Eigen::MatrixXd& m,
                                       const Eigen::Ref<const Eigen::VectorXd>& c, double radius);

 private:
  Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner> svd_;
  Eigen::VectorXd rotated_;  // U' c
};

}  // namespace mpm
