#include "core/mismatch/ball_least_squares.hpp"

#include <algorithm>
#include <cmath>

#include "core/mismatch/calibration.hpp"

namespace mpm {

BallLeastSquares::BallLeastSquares(int size)
    : svd_(size, size, Eigen::ComputeFullU), rotated_(Eigen::VectorXd::Zero(size)) {}

// Newton on 1 / |x| - 1 / radius, which is concave in the multiplier: from 0 on it comes nearer
// from one side (Reinsch 1971).
double BallLeastSquares::distance_square(const Eigen::MatrixXd& m,
                                         const Eigen::Ref<const Eigen::VectorXd>& c,
                                         double radius) {
  if (!(radius > 0.0)) return c.squaredNorm();
  svd_.compute(m);
  rotated_.noalias() = svd_.matrixU().transpose() * c;
  const Eigen::VectorXd& singular = svd_.singularValues();
  const double least = calibration::rounding::kFreeShare * singular(0);
  double multiplier = 0.0;
  for (int step = 0; step < calibration::step_errors::kMostSteps; ++step) {
    double square = 0.0, slope = 0.0;  // |x|^2, and -1/2 of its derivative
    for (Eigen::Index i = 0; i < singular.size() && singular(i) > least; ++i) {
      const double weight = singular(i) * singular(i) + multiplier;
      const double part = singular(i) * rotated_(i) / weight;
      square += part * part;
      slope += part * part / weight;
    }
    const double norm = std::sqrt(square);
    if (!(norm > radius * (1.0 + calibration::step_errors::kExact))) break;
    multiplier += square / slope * (norm - radius) / radius;
  }
  double distance = 0.0;
  for (Eigen::Index i = 0; i < singular.size(); ++i) {
    const double own = singular(i) > least ? singular(i) * singular(i) : 0.0;
    const double share = own > 0.0 ? multiplier / (own + multiplier) : 1.0;
    distance += std::pow(share * rotated_(i), 2);
  }
  return distance;
}

}  // namespace mpm
