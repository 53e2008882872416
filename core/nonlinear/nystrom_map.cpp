#include "core/nonlinear/nystrom_map.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/archive/archive.hpp"
#include "core/nonlinear/calibration.hpp"

namespace mpm {

NystromMap::NystromMap(int dimension, KernelKind kind, int landmarks, int components)
    : FeatureMap(dimension, components), most_landmarks_(landmarks), kernel_{kind, 1.0} {
  if (dimension < 1 || components < 1 || components > landmarks - dimension - 1)
    throw std::invalid_argument("impossible landmarks of a kernel");
}

void NystromMap::begin(const Eigen::Ref<const Eigen::MatrixXd>& points) {
  const Eigen::Index count = std::min<Eigen::Index>(most_landmarks_, points.cols());
  landmarks_.resize(dimension(), count);
  for (Eigen::Index m = 0; m < count; ++m)
    landmarks_.col(m) = points.col(m * points.cols() / count);
  kernel_.bandwidth = median_bandwidth(landmarks_);
  Eigen::MatrixXd linear(count, dimension() + 1);
  linear.col(0).setOnes();
  linear.rightCols(dimension()) = landmarks_.transpose();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(linear);
  const Eigen::MatrixXd basis = Eigen::MatrixXd(factor.householderQ()).leftCols(factor.rank());
  const Eigen::MatrixXd whole = kernel_matrix(kernel_, landmarks_);
  Eigen::MatrixXd matrix = whole;
  matrix -= basis * (basis.transpose() * matrix);
  matrix -= (matrix * basis) * basis.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (matrix + matrix.transpose()));
  weights_.setZero(outputs(), count);
  const double trace = eigen.eigenvalues().sum();
  const double least = calibration::nonlinear_rounding::kEigenvalue * whole.trace();
  double held = 0.0;
  for (Eigen::Index p = 0; p < std::min<Eigen::Index>(outputs(), count); ++p) {
    const double value = eigen.eigenvalues()(count - 1 - p);
    if (!(value > least)) break;
    Eigen::VectorXd vector = eigen.eigenvectors().col(count - 1 - p);
    vector -= basis * (basis.transpose() * vector);
    Eigen::Index largest = 0;  // an eigenvector's sign is anybody's choice
    vector.cwiseAbs().maxCoeff(&largest);
    weights_.row(p) =
        vector.transpose() * ((vector(largest) < 0.0 ? -1.0 : 1.0) / std::sqrt(value));
    held += value;
  }
  held_ = trace > least ? held / trace : 0.0;
  linear_ = factor.solve(whole * weights_.transpose()).transpose();
}

void NystromMap::archive(Archive& a) {
  // not archived: most_landmarks_ (construction)
  auto count = landmarks_.cols();
  a.within(count, 0, most_landmarks_);
  if (a.reads()) {
    landmarks_.resize(count > 0 ? dimension() : 0, count);
    weights_.resize(count > 0 ? outputs() : 0, count);
    linear_.resize(count > 0 ? outputs() : 0, count > 0 ? 1 + dimension() : 0);
  }
  a(kernel_, landmarks_, weights_, linear_, held_);
}

void NystromMap::apply(const double* point, double* features) const {
  std::fill_n(features, outputs(), 0.0);
  for (Eigen::Index p = 0; p < linear_.rows(); ++p) {
    features[p] = -linear_(p, 0);
    for (int d = 0; d < dimension(); ++d) features[p] -= linear_(p, d + 1) * point[d];
  }
  for (Eigen::Index m = 0; m < landmarks_.cols(); ++m) {
    const double value = kernel_(point, landmarks_.col(m).data(), dimension());
    for (int p = 0; p < outputs(); ++p) features[p] += weights_(p, m) * value;
  }
}

}  // namespace mpm
