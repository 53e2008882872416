#include "core/nonlinear/term_selection.hpp"

#include <stdexcept>

#include "core/nonlinear/calibration.hpp"

namespace mpm {

using calibration::nonlinear_rounding::kOwnShare;

TermSelection::TermSelection(int first, int count)
    : first_(first),
      count_(count),
      columns_(Eigen::MatrixXd::Zero(count, count)),
      rest_(Eigen::VectorXd::Zero(count)),
      scales_(Eigen::VectorXd::Zero(count)),
      basis_(Eigen::MatrixXd::Zero(count, count)) {
  if (first < 1 || count < 1) throw std::invalid_argument("no columns to select among");
}

void TermSelection::read(const GivensQr& factor, const Eigen::Ref<const Eigen::VectorXd>& rotated) {
  factor.centred_norms(first_, scales_);
  for (int r = 0; r < count_; ++r)
    for (int c = r; c < count_; ++c) columns_(r, c) = factor.r(first_ + r, first_ + c);
  for (int c = 0; c < count_; ++c) columns_.col(c).tail(count_ - 1 - c).setZero();
  rest_ = rotated;
  // What the factor itself found to be rounding has no say.
  for (int c = 0; c < count_; ++c)
    if (!(factor.r(first_ + c, first_ + c) > kOwnShare * scales_(c))) rest_(c) = 0.0;
}

int TermSelection::orthogonalise(const std::vector<int>& columns) {
  int count = 0;
  for (const int c : columns) {
    auto own = basis_.col(count);
    own = columns_.col(c);
    for (int b = 0; b < count; ++b) own -= basis_.col(b).dot(own) * basis_.col(b);
    const double norm = own.norm();
    if (!(norm > kOwnShare * scales_(c))) continue;
    own /= norm;
    ++count;
  }
  return count;
}

TermSelection::Gain TermSelection::gain(const std::vector<int>& columns) {
  Gain found{0.0, orthogonalise(columns)};
  for (int b = 0; b < found.columns; ++b) {
    const double explained = basis_.col(b).dot(rest_);
    found.square += explained * explained;
  }
  return found;
}

TermSelection::Gain TermSelection::take(const std::vector<int>& columns) {
  const Gain found = gain(columns);
  for (int b = 0; b < found.columns; ++b) {
    const auto direction = basis_.col(b);
    rest_ -= direction.dot(rest_) * direction;
    for (int c = 0; c < count_; ++c) columns_.col(c) -= direction.dot(columns_.col(c)) * direction;
  }
  return found;
}

TermSelection::Gain TermSelection::all() const {
  Gain found{rest_.squaredNorm(), 0};
  for (int c = 0; c < count_; ++c) found.columns += columns_(c, c) > kOwnShare * scales_(c) ? 1 : 0;
  return found;
}

double TermSelection::norm_left(int column) const {
  const double norm = columns_.col(column).norm();
  return norm > kOwnShare * scales_(column) ? norm : 0.0;
}

}  // namespace mpm
