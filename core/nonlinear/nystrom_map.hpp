#pragma once

#include "core/nonlinear/feature_map.hpp"
#include "core/nonlinear/kernel.hpp"

namespace mpm {

/// The leading principal components of a kernel, from part of its matrix: of the kernel matrix K of
/// the landmarks (at most `landmarks` of the points, evenly chosen) the eigenvectors v_p of Q K Q
/// with the largest eigenvalues d_p,
///
///     phi_p(x) = d_p^-1/2 v_p' Q k(x) - (a_p + b_p'x),   k(x)_m = kernel(x, landmark m),
///
/// so that phi(x)'phi(y) is the Nystrom approximation of the kernel (Williams and Seeger 2001),
/// reduced as by kernel PCA (Scholkopf, Smola and Muller 1998). Q takes off what a constant and the
/// points themselves explain of the landmarks, a_p + b_p'x what they explain there of phi_p: what
/// is left is what a linear model cannot say.
class NystromMap : public FeatureMap {
 public:
  /// The bandwidth is the median rule's. 1 <= components <= landmarks - dimension - 1.
  NystromMap(int dimension, KernelKind kind, int landmarks, int components);

  void begin(const Eigen::Ref<const Eigen::MatrixXd>& points) override;
  void apply(const double* point, double* features) const override;
  void archive(Archive& a) override;

  [[nodiscard]] const Kernel& kernel() const { return kernel_; }
  /// Of the trace of Q K Q, what the components hold, 0..1.
  [[nodiscard]] double held() const { return held_; }

 private:
  int most_landmarks_;
  Kernel kernel_;
  Eigen::MatrixXd landmarks_;  // dimension x count
  Eigen::MatrixXd weights_;    // components x count
  Eigen::MatrixXd linear_;     // components x (1 + dimension)
  double held_ = 0.0;
};

}  // namespace mpm
