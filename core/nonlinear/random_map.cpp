#include "core/nonlinear/random_map.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "core/archive/archive.hpp"
#include "core/nonlinear/kernel.hpp"

namespace mpm {

RandomMap::RandomMap(int dimension, int frequencies, std::uint64_t seed)
    : FeatureMap(dimension, 2 * frequencies), frequencies_(dimension, frequencies) {
  if (dimension < 1 || frequencies < 1) throw std::invalid_argument("no frequencies");
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (Eigen::Index d = 0; d < frequencies_.size(); ++d) frequencies_(d) = normal(random);
}

void RandomMap::begin(const Eigen::Ref<const Eigen::MatrixXd>& points) {
  inverse_width_ = 1.0 / median_bandwidth(points);
}

void RandomMap::archive(Archive& a) {
  // not archived: frequencies_ (construction)
  a(inverse_width_);
}

void RandomMap::apply(const double* point, double* features) const {
  if (inverse_width_ == 0.0) {
    std::fill_n(features, outputs(), 0.0);
    return;
  }
  const double scale = 1.0 / std::sqrt(static_cast<double>(frequencies_.cols()));
  for (Eigen::Index d = 0; d < frequencies_.cols(); ++d) {
    double phase = 0.0;
    for (int i = 0; i < dimension(); ++i) phase += frequencies_(i, d) * point[i];
    *features++ = scale * std::cos(inverse_width_ * phase);
    *features++ = scale * std::sin(inverse_width_ * phase);
  }
}

}  // namespace mpm
