#include "core/mismatch/usual_error_space.hpp"

#include "core/mismatch/calibration.hpp"
#include "core/mismatch/signature.hpp"

namespace mpm {

UsualErrorSpace::UsualErrorSpace(int block) : basis_(Eigen::MatrixXd::Zero(block, kUsualErrors)) {}

// Gram-Schmidt; twice is enough (Kahan; Parlett 1980).
void UsualErrorSpace::add(Eigen::VectorXd& error) {
  const double before = error.norm();
  for (int pass = 0; pass < 2; ++pass)
    for (int c = 0; c < rank_; ++c) error -= basis_.col(c).dot(error) * basis_.col(c);
  const double after = error.norm();
  if (!(after > calibration::rounding::kIndependentShare * before)) return;
  basis_.col(rank_) = error / after;
  ++rank_;
}

double UsualErrorSpace::explained(const Eigen::VectorXd& x) const {
  double square = 0.0;
  for (int c = 0; c < rank_; ++c) {
    const double part = basis_.col(c).dot(x);
    square += part * part;
  }
  return square;
}

void UsualErrorSpace::coordinates(const Eigen::Ref<const Eigen::VectorXd>& x,
                                  Eigen::Ref<Eigen::VectorXd> out) const {
  for (int c = 0; c < rank_; ++c) out(c) = basis_.col(c).dot(x);
}

}  // namespace mpm
