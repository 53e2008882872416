#include "core/regression/givens_qr.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>

namespace mpm {
namespace {

// A regressor entry that is left with less than this fraction of the column's magnitude after the
// earlier columns are rotated off is rounding noise: |x| <= 64 eps * max |x| is taken for 0.
constexpr double kNoise = 64 * 2.220446049250313e-16;

}  // namespace

void GivensQr::AlignedDelete::operator()(double* p) const {
  ::operator delete[](p, std::align_val_t{kRowAlignment});
}

GivensQr::AlignedArray GivensQr::make_aligned(std::size_t count) {
  AlignedArray array(static_cast<double*>(
      ::operator new[](count * sizeof(double), std::align_val_t{kRowAlignment})));
  std::fill_n(array.get(), count, 0.0);
  return array;
}

GivensQr::GivensQr(int columns, int responses) : columns_(columns), responses_(responses) {
  if (columns <= 0 || responses <= 0)
    throw std::invalid_argument("GivensQr needs at least one column and one response");
  const auto total = static_cast<std::size_t>(columns) + static_cast<std::size_t>(responses);
  width_ = (total + kRowGranule - 1) / kRowGranule * kRowGranule;
  for (int i = 0; i < columns; ++i) {
    offsets_.push_back(factor_size_);
    factor_size_ += width_ - row_begin(i);
  }
  factor_ = make_aligned(factor_size_);
  row_ = make_aligned(width_);
  magnitudes_.assign(static_cast<std::size_t>(columns), 0.0);
  squares_.assign(static_cast<std::size_t>(responses), 0.0);
  products_.assign(static_cast<std::size_t>(responses), 0.0);
}

void GivensQr::update(double lambda) {
  const double root = std::sqrt(lambda);
  double* x = row_.get();
  for (int i = 0; i < columns_; ++i) {
    double& magnitude = magnitudes_[static_cast<std::size_t>(i)];
    magnitude = std::max(magnitude * root, std::abs(x[i]));
  }
  for (int i = 0; i < columns_; ++i) {
    const std::size_t begin = row_begin(i);
    double* stored = factor_.get() + offsets_[static_cast<std::size_t>(i)];
    double& diagonal = stored[static_cast<std::size_t>(i) - begin];
    if (std::abs(x[i]) <= kNoise * magnitudes_[static_cast<std::size_t>(i)]) x[i] = 0.0;
    const Rotation rotation = make_rotation(root * diagonal, x[i]);
    rotate_rows(stored, x + begin, width_ - begin, rotation, root);
    diagonal = rotation.radius;
    x[i] = 0.0;
  }
  const double* left = x + columns_;
  for (int k = 0; k < responses_; ++k) {
    const auto s = static_cast<std::size_t>(k);
    squares_[s] = lambda * squares_[s] + left[k] * left[k];
    products_[s] = lambda * products_[s] + left[0] * left[k];
  }
}

void GivensQr::scale(double factor) {
  for (std::size_t i = 0; i < factor_size_; ++i) factor_[i] *= factor;
  for (double& magnitude : magnitudes_) magnitude *= factor;
  for (double& square : squares_) square *= factor * factor;
  for (double& product : products_) product *= factor * factor;
}

void GivensQr::clear() {
  std::fill_n(factor_.get(), factor_size_, 0.0);
  std::fill(magnitudes_.begin(), magnitudes_.end(), 0.0);
  std::fill(squares_.begin(), squares_.end(), 0.0);
  std::fill(products_.begin(), products_.end(), 0.0);
}

double GivensQr::centred_norm(int j) const {
  double sum = 0.0;
  for (int i = j == 0 ? 0 : 1; i <= j; ++i) sum += r(i, j) * r(i, j);
  return std::sqrt(sum);
}

void GivensQr::solve(int response, Eigen::Ref<Eigen::VectorXd> coefficients) const {
  for (int i = columns_ - 1; i >= 0; --i) {
    const double diagonal = r(i, i);
    if (diagonal <= kNegligible * magnitudes_[static_cast<std::size_t>(i)]) {
      coefficients(i) = 0.0;
      continue;
    }
    const int rest = columns_ - 1 - i;
    const Eigen::Map<const Eigen::VectorXd> row(entry(i, i) + 1, rest);
    coefficients(i) = (z(i, response) - row.dot(coefficients.tail(rest))) / diagonal;
  }
}

}  // namespace mpm
