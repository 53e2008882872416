#pragma once

#include <cstdint>

#include "core/nonlinear/feature_map.hpp"

namespace mpm {

/// Random Fourier features of the Gaussian kernel of median width h (Rahimi and Recht 2007):
///
///     sqrt(1 / D) (cos w_d'x, sin w_d'x), d = 1..D,   w_d ~ N(0, I / h^2),
///
/// whose products are the kernel's on average, with an s.d. of about sqrt(1 / 2 D).
class RandomMap : public FeatureMap {
 public:
  /// frequencies >= 1.
  RandomMap(int dimension, int frequencies, std::uint64_t seed);

  void begin(const Eigen::Ref<const Eigen::MatrixXd>& points) override;
  void apply(const double* point, double* features) const override;
  void archive(Archive& a) override;

 private:
  Eigen::MatrixXd frequencies_;  // dimension x count, for a width of 1
  double inverse_width_ = 0.0;
};

}  // namespace mpm
