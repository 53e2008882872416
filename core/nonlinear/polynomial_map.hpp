#pragma once

#include <array>
#include <vector>

#include "core/nonlinear/feature_map.hpp"

namespace mpm {

/// Monomials x^p y^q of one or two values (Billings and Voon 1983 test residuals on such).
class PolynomialMap : public FeatureMap {
 public:
  using Exponents = std::array<int, 2>;  ///< each >= 0; the second one is 0 of one value

  PolynomialMap(int dimension, std::vector<Exponents> monomials);

  void begin(const Eigen::Ref<const Eigen::MatrixXd>& points) override;
  void apply(const double* point, double* features) const override;
  void archive(Archive& a) override;

 private:
  std::vector<Exponents> monomials_;
};

}  // namespace mpm
