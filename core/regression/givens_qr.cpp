#include "core/regression/givens_qr.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <stdexcept>

namespace mpm {
namespace {

// A regressor entry that is left with less than this fraction of the column's magnitude after the
// earlier columns are rotated off is rounding noise: |x| <= 64 eps * max |x| is taken for 0.
constexpr double kNoise = 64 * 2.220446049250313e-16;

using Granule = Eigen::Array<double, static_cast<int>(kRowGranule), 1>;

// Of a stored row at least this much must be kept for r + s x' to lose no more than a digit.
constexpr double kMostlyKept = 0.1;

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
  preview_row_ = make_aligned(width_);
  weights_.assign(static_cast<std::size_t>(columns), 0.0);
  magnitudes_.assign(static_cast<std::size_t>(columns), 0.0);
  squares_.assign(static_cast<std::size_t>(responses), 0.0);
  products_.assign(static_cast<std::size_t>(responses), 0.0);
}

double GivensQr::denoised(int column, double entry) const {
  return std::abs(entry) <= kNoise * magnitudes_[static_cast<std::size_t>(column)] ? 0.0 : entry;
}

// With q = 1 / w, w' = w lambda d / d' reads q' = q + x_i^2 / (lambda d): entry after entry only an
// addition has to wait for the one before, no division.
GivensQr::Share GivensQr::weigh(int i, double lambda, double entry, double& inverse_row_weight) {
  double& weight = weights_[static_cast<std::size_t>(i)];
  const double faded = lambda * weight;
  const double square = entry * entry;
  const double row_weight = 1.0 / inverse_row_weight;
  const double taken = row_weight * square;
  weight = faded + taken;
  if (!(taken > 0.0)) return {0.0, 1.0};
  inverse_row_weight += square / faded;
  const double inverse = 1.0 / weight;
  return {row_weight * entry * inverse, faded * inverse};
}

void GivensQr::update(double lambda) {
  const double root_lambda = std::sqrt(lambda);
  for (int i = 0; i < columns_; ++i) {
    double& magnitude = magnitudes_[static_cast<std::size_t>(i)];
    magnitude = std::max(magnitude * root_lambda, std::abs(row_[static_cast<std::size_t>(i)]));
  }
  accumulate(lambda, eliminate(lambda, 1.0));
}

double GivensQr::rotate(double lambda, double weight, const double* magnitudes) {
  std::copy_n(magnitudes, columns_, magnitudes_.begin());
  return eliminate(lambda, weight);
}

double GivensQr::eliminate(double lambda, double weight) {
  double* x = row_.get();
  constexpr int kGroup = static_cast<int>(kRowGranule);
  std::array<double*, kRowGranule> rows{};
  std::array<double, kRowGranule> entries{};
  std::array<double, kRowGranule> gains{};
  std::array<double, kRowGranule> kept{};
  std::array<Granule, kRowGranule> heads;
  double inverse_row_weight = 1.0 / weight;
  int i = 0;
  for (; i + kGroup <= columns_; i += kGroup) {
    // The triangle of the group's own columns first, then all columns behind it in one pass.
    // Stored entries left of the diagonal are 0, which all eight lanes of an operation preserve.
    Granule head = Eigen::Map<const Granule>(x + i);
#pragma GCC unroll 8
    for (std::size_t a = 0; a < kRowGranule; ++a) {
      rows[a] = factor_.get() + offsets_[static_cast<std::size_t>(i) + a];
      const auto lane = static_cast<Eigen::Index>(a);
      entries[a] = denoised(i + static_cast<int>(a), head(lane));
      heads[a] = head;
      head -= entries[a] * Eigen::Map<const Granule>(rows[a]);
      head(lane) = 0.0;
    }
    double least_kept = 1.0;
    for (std::size_t a = 0; a < kRowGranule; ++a) {
      const Share share = weigh(i + static_cast<int>(a), lambda, entries[a], inverse_row_weight);
      Eigen::Map<Granule> stored(rows[a]);
      stored = share.kept * stored + share.gain * heads[a];
      rows[a][a] = 1.0;
      rows[a] += kRowGranule;
      gains[a] = share.gain;
      kept[a] = share.kept;
      least_kept = std::min(least_kept, share.kept);
    }
    double* behind = x + i + kGroup;
    const std::size_t count = width_ - static_cast<std::size_t>(i + kGroup);
    if (least_kept >= kMostlyKept) {
      eliminate_rows(rows.data(), behind, count, entries.data(), gains.data());
    } else {
      for (std::size_t a = 0; a < kRowGranule; ++a)
        blend_row(rows[a], behind, count, entries[a], gains[a], kept[a]);
    }
  }
  for (; i < columns_; ++i) {
    const std::size_t begin = row_begin(i);
    double* stored = factor_.get() + offsets_[static_cast<std::size_t>(i)];
    const double entry = denoised(i, x[i]);
    const Share share = weigh(i, lambda, entry, inverse_row_weight);
    blend_row(stored, x + begin, width_ - begin, entry, share.gain, share.kept);
    stored[static_cast<std::size_t>(i) - begin] = 1.0;
    x[i] = 0.0;
  }

  return 1.0 / inverse_row_weight;
}

void GivensQr::accumulate(double lambda, double left_weight) {
  const double* left = row_.get() + columns_;
  for (int k = 0; k < responses_; ++k) {
    const auto s = static_cast<std::size_t>(k);
    squares_[s] = lambda * squares_[s] + left_weight * left[k] * left[k];
    products_[s] = lambda * products_[s] + left_weight * left[0] * left[k];
  }
}

GivensQr::Preview GivensQr::preview(double lambda) {
  double* x = preview_row_.get();
  std::copy_n(row_.get(), width_, x);
  constexpr int kGroup = static_cast<int>(kRowGranule);
  std::array<const double*, kRowGranule> rows{};
  std::array<double, kRowGranule> entries{};
  double inverse_share = 1.0;
  const auto take = [&](int i, double entry) {
    const auto s = static_cast<std::size_t>(i);
    if (std::abs(entry) <= kNoise * std::max(magnitudes_[s], std::abs(row_[s]))) return 0.0;
    const double square = entry * entry;
    if (square > 0.0) inverse_share += square / (lambda * weights_[s]);
    return entry;
  };
  int i = 0;
  for (; i + kGroup <= columns_; i += kGroup) {
    Granule head = Eigen::Map<const Granule>(x + i);
#pragma GCC unroll 8
    for (std::size_t a = 0; a < kRowGranule; ++a) {
      const double* stored = factor_.get() + offsets_[static_cast<std::size_t>(i) + a];
      entries[a] = take(i + static_cast<int>(a), head(static_cast<Eigen::Index>(a)));
      head -= entries[a] * Eigen::Map<const Granule>(stored);
      rows[a] = stored + kRowGranule;
    }
    project_rows(rows.data(), x + i + kGroup, width_ - static_cast<std::size_t>(i + kGroup),
                 entries.data());
  }
  for (; i < columns_; ++i) {
    const std::size_t begin = row_begin(i);
    project_row(factor_.get() + offsets_[static_cast<std::size_t>(i)], x + begin, width_ - begin,
                take(i, x[i]));
    x[i] = 0.0;
  }
  return {x[columns_], 1.0 / inverse_share};
}

void GivensQr::scale(double factor) {
  const double square = factor * factor;
  for (double& weight : weights_) weight *= square;
  for (double& magnitude : magnitudes_) magnitude *= factor;
  for (double& sum : squares_) sum *= square;
  for (double& sum : products_) sum *= square;
}

void GivensQr::clear() {
  std::fill_n(factor_.get(), factor_size_, 0.0);
  std::fill(weights_.begin(), weights_.end(), 0.0);
  std::fill(magnitudes_.begin(), magnitudes_.end(), 0.0);
  std::fill(squares_.begin(), squares_.end(), 0.0);
  std::fill(products_.begin(), products_.end(), 0.0);
}

double GivensQr::centred_norm(int j) const {
  double sum = 0.0;
  for (int i = j == 0 ? 0 : 1; i <= j; ++i)
    sum += weights_[static_cast<std::size_t>(i)] * *entry(i, j) * *entry(i, j);
  return std::sqrt(sum);
}

void GivensQr::centred_norms(int first, Eigen::Ref<Eigen::VectorXd> norms) const {
  const int end = first + static_cast<int>(norms.size());
  norms.setZero();
  for (int i = 1; i < end; ++i) {
    const double weight = weights_[static_cast<std::size_t>(i)];
    const int begin = std::max(first, i);
    const double* row = entry(i, begin);
    for (int j = begin; j < end; ++j, ++row) norms(j - first) += weight * *row * *row;
  }
  norms = norms.cwiseSqrt();
}

void GivensQr::solve(int response, int leading, Eigen::Ref<Eigen::VectorXd> coefficients) const {
  for (int i = leading - 1; i >= 0; --i) {
    const double diagonal = root(i);
    if (diagonal <= kNegligible * magnitudes_[static_cast<std::size_t>(i)]) {
      coefficients(i) = 0.0;
      continue;
    }
    const int rest = leading - 1 - i;
    const Eigen::Map<const Eigen::VectorXd> row(entry(i, i) + 1, rest);
    coefficients(i) = *entry(i, columns_ + response) - row.dot(coefficients.segment(i + 1, rest));
  }
}

}  // namespace mpm
