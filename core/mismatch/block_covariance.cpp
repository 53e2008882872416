#include "core/mismatch/block_covariance.hpp"

#include <algorithm>
#include <cmath>

#include "core/mismatch/calibration.hpp"
#include "core/regression/rotation.hpp"

namespace mpm {

BlockCovariance::BlockCovariance(const InputEstimates& estimates) : block_(estimates.block()) {
  const auto rows = static_cast<std::size_t>(block_);
  factor_.setZero(block_, block_);
  behind_ = make_aligned(rows * static_cast<std::size_t>(estimates.padded()));
  shares_.assign(rows, 0.0);
}

void BlockCovariance::read(const InputEstimates& estimates, int input) {
  const int at = input * block_;
  const int behind = (estimates.inputs() - 1 - input) * block_;
  for (int r = 0; r < block_; ++r)
    factor_.row(r) =
        Eigen::Map<const Eigen::RowVectorXd>(estimates.inverse_row(at + r) + at, block_);
  if (behind == 0) return;
  const std::size_t stride =
      (static_cast<std::size_t>(behind) + kRowGranule - 1) / kRowGranule * kRowGranule;
  for (int r = 0; r < block_; ++r) {
    double* row = behind_.get() + static_cast<std::size_t>(r) * stride;
    std::fill(std::copy_n(estimates.inverse_row(at + r) + at + block_, behind, row), row + stride,
              0.0);
  }
  // Last row first: the rows above have nothing in the triangle's columns that are done.
  for (int r = block_ - 1; r >= 0; --r) reflect(r, stride);
}

void BlockCovariance::read(const GivensQr& factor, int first) {
  factor_.setZero();
  for (int i = block_ - 1; i >= 0; --i) {
    for (int c = i + 1; c < block_; ++c)
      factor_.row(i) -= factor.r(first + i, first + c) * factor_.row(c);
    factor_(i, i) = 1.0;
    factor_.row(i) /= std::max(factor.r(first + i, first + i), calibration::rounding::kOwnShare);
  }
}

void BlockCovariance::reflect(int row, std::size_t stride) {
  const auto behind_row = [&](int r) {
    return behind_.get() + static_cast<std::size_t>(r) * stride;
  };
  double* reflector = behind_row(row);
  double square = 0.0;
  inner_products(reflector, {reflector, stride, 1}, stride, &square);
  const double own = factor_(row, row);
  const double norm = std::sqrt(own * own + square);
  const double first = own + norm;  // own > 0; the reflector is [first, row]
  const double scale = 1.0 / (norm * first);
  inner_products(reflector, {behind_.get(), stride, row}, stride, shares_.data());
  for (int c = 0; c < row; ++c) {
    const double share = (factor_(c, row) * first + shares_[static_cast<std::size_t>(c)]) * scale;
    factor_(c, row) -= share * first;
    project_row(reflector, behind_row(c), stride, share);
  }
  factor_(row, row) = -norm;
}

void BlockCovariance::whiten(Eigen::Ref<Eigen::VectorXd> x) const {
  for (int r = block_ - 1; r >= 0; --r) {
    const int rest = block_ - 1 - r;
    x(r) = (x(r) - factor_.row(r).tail(rest).dot(x.tail(rest))) / factor_(r, r);
  }
}

void BlockCovariance::whiten_transposed(Eigen::Ref<Eigen::VectorXd> x) const {
  for (int r = 0; r < block_; ++r) {
    const int rest = block_ - 1 - r;
    x(r) /= factor_(r, r);
    x.tail(rest) -= x(r) * factor_.row(r).tail(rest).transpose();
  }
}

double BlockCovariance::variance_of(const Eigen::VectorXd& x) const {
  double square = 0.0;
  for (int c = 0; c < block_; ++c) {
    const double part = factor_.col(c).head(c + 1).dot(x.head(c + 1));
    square += part * part;
  }
  return square;
}

}  // namespace mpm
