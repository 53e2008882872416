#include "core/nonlinear/left_out.hpp"

#include <stdexcept>

#include "core/nonlinear/calibration.hpp"

namespace mpm {
namespace {

using calibration::nonlinear_rounding::kOwnShare;

}  // namespace

LeftOut::LeftOut(int first, int count)
    : first_(first),
      count_(count),
      inverse_(Eigen::MatrixXd::Zero(count, count)),
      rotated_(Eigen::VectorXd::Zero(count)),
      coefficients_(Eigen::VectorXd::Zero(count)),
      scales_(Eigen::VectorXd::Ones(count)),
      live_(static_cast<std::size_t>(count), false),
      kept_(Eigen::MatrixXd::Zero(count, count)),
      right_(Eigen::VectorXd::Zero(count)) {
  if (first < 1 || count < 1) throw std::invalid_argument("no columns to leave out");
}

// The columns are scaled to norms of 1; one that takes no part stands by itself.
void LeftOut::read(const GivensQr& factor, const Eigen::Ref<const Eigen::VectorXd>& rotated) {
  factor.centred_norms(first_, scales_);
  for (int c = 0; c < count_; ++c) {
    const double own = factor.r(first_ + c, first_ + c);
    live_[static_cast<std::size_t>(c)] = own > kOwnShare * scales_(c);
    if (!live_[static_cast<std::size_t>(c)]) scales_(c) = 1.0;
    rotated_(c) = live_[static_cast<std::size_t>(c)] ? rotated(c) : 0.0;
  }
  // Row by row from the last one: R^-1 (r, :) = (unit r - sum_{c > r} R(r, c) R^-1 (c, :)) / R(r,
  // r).
  inverse_.setZero();
  for (int r = count_ - 1; r >= 0; --r) {
    inverse_(r, r) = 1.0;
    if (!live_[static_cast<std::size_t>(r)]) continue;
    for (int c = r + 1; c < count_; ++c)
      if (live_[static_cast<std::size_t>(c)])
        inverse_.col(r) -= factor.r(first_ + r, first_ + c) / scales_(c) * inverse_.col(c);
    inverse_.col(r) *= scales_(r) / factor.r(first_ + r, first_ + r);
  }
  for (int c = 0; c < count_; ++c) coefficients_(c) = inverse_.col(c).dot(rotated_);
}

int LeftOut::gather(const std::vector<int>& columns) {
  int count = 0;
  for (const int c : columns)
    if (live_[static_cast<std::size_t>(c)]) kept_.col(count++) = inverse_.col(c);
  return count;
}

// Modified Gram-Schmidt, the right-hand side with it (Bjorck 1996, section 2.4).
double LeftOut::orthogonalise(int count) {
  double square = 0.0;
  for (int i = 0; i < count; ++i) {
    const double norm = kept_.col(i).norm();
    if (!(norm > 0.0)) continue;
    kept_.col(i) /= norm;
    const double own = right_(i) / norm;
    square += own * own;
    for (int l = i + 1; l < count; ++l) {
      const double product = kept_.col(i).dot(kept_.col(l));
      kept_.col(l) -= product * kept_.col(i);
      right_(l) -= product * own;
    }
  }
  return square;
}

LeftOut::Loss LeftOut::loss(const std::vector<int>& columns) {
  const int count = gather(columns);
  int at = 0;
  for (const int c : columns)
    if (live_[static_cast<std::size_t>(c)]) right_(at++) = coefficients_(c);
  return {orthogonalise(count), count};
}

double LeftOut::loss_of(const std::vector<int>& columns, int column, double value) {
  if (!live_[static_cast<std::size_t>(column)]) return 0.0;
  const int count = gather(columns);
  int at = 0;
  for (const int c : columns)
    if (live_[static_cast<std::size_t>(c)])
      right_(at++) = c == column ? value * scales_(column) : 0.0;
  return orthogonalise(count);
}

}  // namespace mpm
