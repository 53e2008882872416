#include "core/nonlinear/polynomial_map.hpp"

#include <stdexcept>
#include <utility>

namespace mpm {
namespace {

double power(double value, int exponent) {
  double result = 1.0;
  for (int e = 0; e < exponent; ++e) result *= value;
  return result;
}

}  // namespace

PolynomialMap::PolynomialMap(int dimension, std::vector<Exponents> monomials)
    : FeatureMap(dimension, static_cast<int>(monomials.size())), monomials_(std::move(monomials)) {
  if (dimension < 1 || dimension > 2) throw std::invalid_argument("monomials of one or two values");
}

void PolynomialMap::begin(const Eigen::Ref<const Eigen::MatrixXd>& /*points*/) {}

// Its monomials are all that it has.
void PolynomialMap::archive(Archive& /*a*/) {
  // not archived: monomials_ (construction)
}

void PolynomialMap::apply(const double* point, double* features) const {
  for (const Exponents& exponents : monomials_)
    *features++ =
        power(point[0], exponents[0]) * (dimension() > 1 ? power(point[1], exponents[1]) : 1.0);
}

}  // namespace mpm
