#include "core/regression/givens_qr.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/archive/archive.hpp"
#include "core/regression/calibration.hpp"

namespace mpm {

using calibration::rounding::kMostlyKept;

GivensQr::GivensQr(int columns, int responses)
    : columns_(columns), responses_(responses), own_(std::max(columns + responses, 1), 1) {
  if (columns <= 0 || responses <= 0)
    throw std::invalid_argument("GivensQr needs at least one column and one response");
  const auto total = static_cast<std::size_t>(columns) + static_cast<std::size_t>(responses);
  width_ = (total + kRowGranule - 1) / kRowGranule * kRowGranule;
  for (int i = 0; i < columns; ++i) {
    offsets_.push_back(factor_size_);
    factor_size_ += width_ - row_begin(i);
  }
  factor_ = make_aligned(factor_size_);
  weights_.assign(static_cast<std::size_t>(columns), 0.0);
  magnitudes_.assign(static_cast<std::size_t>(columns), 0.0);
  squares_.assign(static_cast<std::size_t>(responses), 0.0);
  products_.assign(static_cast<std::size_t>(responses), 0.0);
}

void GivensQr::update_batch(RowBatch& batch, int count, double lambda) {
  if (count == 0) return;
  const double root_lambda = std::sqrt(lambda);
  double* magnitudes = batch.magnitudes_.get();
  for (int k = 0; k < count; ++k) {
    const double* row = batch.row(k);
    double* out = magnitudes + batch.offset(k);
    for (int i = 0; i < columns_; ++i) {
      double& magnitude = magnitudes_[static_cast<std::size_t>(i)];
      magnitude = std::max(magnitude * root_lambda, std::abs(row[i]));
      out[i] = magnitude;
    }
    batch.inverse_row_weights_[static_cast<std::size_t>(k)] = 1.0;
  }
  eliminate_batch(batch, count, lambda, magnitudes, batch.stride_);
  for (int k = 0; k < count; ++k)
    accumulate(lambda, 1.0 / batch.inverse_row_weights_[static_cast<std::size_t>(k)],
               left(batch, k));
}

void GivensQr::rotate_batch(RowBatch& batch, int count, double lambda, double* weights,
                            const double* magnitudes, std::size_t stride) {
  for (int k = 0; k < count; ++k)
    batch.inverse_row_weights_[static_cast<std::size_t>(k)] = 1.0 / weights[k];
  std::copy_n(magnitudes + static_cast<std::size_t>(count - 1) * stride, columns_,
              magnitudes_.begin());
  eliminate_batch(batch, count, lambda, magnitudes, stride);
  for (int k = 0; k < count; ++k)
    weights[k] = 1.0 / batch.inverse_row_weights_[static_cast<std::size_t>(k)];
}

void GivensQr::accumulate_batch(const RowBatch& batch, int count, double lambda,
                                const double* weights) {
  for (int k = 0; k < count; ++k) accumulate(lambda, weights[k], left(batch, k));
}

void GivensQr::accumulate(double lambda, double left_weight, const double* left) {
  for (int k = 0; k < responses_; ++k) {
    const auto s = static_cast<std::size_t>(k);
    squares_[s] = lambda * squares_[s] + left_weight * left[k] * left[k];
    products_[s] = lambda * products_[s] + left_weight * left[0] * left[k];
  }
}

// The triangle of a group of columns first, then all columns behind it in one pass.
void GivensQr::eliminate_batch(RowBatch& batch, int count, double lambda, const double* magnitudes,
                               std::size_t stride) {
  constexpr int kGroup = static_cast<int>(kRowGranule);
  std::array<double*, kRowGranule> rows{};
  const auto shares = static_cast<std::size_t>(count) * kRowGranule;
  int i = 0;
  for (; i + kGroup <= columns_; i += kGroup) {
    for (std::size_t a = 0; a < kRowGranule; ++a)
      rows[a] = factor_.get() + offsets_[static_cast<std::size_t>(i) + a];
    eliminate_heads(rows.data(), {batch.row(0) + i, batch.stride_, count},
                    {lambda, weights_.data() + i, batch.inverse_row_weights_.get(), magnitudes + i,
                     stride, batch.entries_.get(), batch.gains_.get(), batch.kept_.get()});
    for (double*& row : rows) row += kRowGranule;
    const std::size_t behind = width_ - static_cast<std::size_t>(i + kGroup);
    const double* entries = batch.entries_.get();
    const double* gains = batch.gains_.get();
    const double* kept = batch.kept_.get();
    if (*std::min_element(kept, kept + shares) >= kMostlyKept) {
      eliminate_block(rows.data(), {batch.row(0) + i + kGroup, batch.stride_, count}, behind,
                      entries, gains);
      continue;
    }
    for (std::size_t at = 0; at < shares; ++at) {
      double* x = batch.row(static_cast<int>(at / kRowGranule)) + i + kGroup;
      double* stored = rows[at % kRowGranule];
      if (kept[at] >= kMostlyKept)
        eliminate_row(stored, x, behind, entries[at], gains[at]);
      else
        blend_row(stored, x, behind, entries[at], gains[at], kept[at]);
    }
  }
  for (; i < columns_; ++i) eliminate_column(i, batch, count, lambda, magnitudes, stride);
}

// The last columns, fewer than a group. As the groups do it: with q = 1 / w, w' = w lambda d / d'
// reads q' = q + x_i^2 / (lambda d).
void GivensQr::eliminate_column(int column, RowBatch& batch, int count, double lambda,
                                const double* magnitudes, std::size_t stride) {
  const auto c = static_cast<std::size_t>(column);
  const std::size_t begin = row_begin(column);
  double* stored = factor_.get() + offsets_[c];
  double& weight = weights_[c];
  for (int k = 0; k < count; ++k) {
    const auto s = static_cast<std::size_t>(k);
    double* x = batch.row(k);
    const double entry =
        std::abs(x[c]) <= calibration::rounding::kNoise * magnitudes[s * stride + c] ? 0.0 : x[c];
    double& inverse_row_weight = batch.inverse_row_weights_[s];
    const double faded = lambda * weight;
    const double square = entry * entry;
    const double row_weight = 1.0 / inverse_row_weight;
    const double taken = row_weight * entry * entry;
    weight = std::fma(lambda, weight, taken);
    double gain = 0.0;
    double kept = 1.0;
    if (square > 0.0 && inverse_row_weight < std::numeric_limits<double>::infinity())
      inverse_row_weight += square / faded;
    if (taken > 0.0) {
      gain = row_weight * entry / weight;
      kept = faded / weight;
    }
    blend_row(stored, x + begin, width_ - begin, entry, gain, kept);
    stored[c - begin] = 1.0;
    x[c] = 0.0;
  }
}

void GivensQr::preview_batch(RowBatch& batch, int count, Preview* previews) const {
  constexpr int kGroup = static_cast<int>(kRowGranule);
  std::array<const double*, kRowGranule> rows{};
  double* magnitudes = batch.magnitudes_.get();
  for (int c = 0; c < columns_; ++c) {
    const auto s = static_cast<std::size_t>(c);
    magnitudes[s] = magnitudes_[s];
    for (int k = 0; k < count; ++k)
      magnitudes[s] = std::max(magnitudes[s], std::abs(batch.row(k)[c]));
  }
  for (int k = 0; k < count; ++k) previews[k].leverage = 0.0;
  const auto count_in = [&](int c, int k, double entry) {
    if (entry != 0.0) previews[k].leverage += entry * entry / weights_[static_cast<std::size_t>(c)];
  };
  int i = 0;
  for (; i + kGroup <= columns_; i += kGroup) {
    for (std::size_t a = 0; a < kRowGranule; ++a)
      rows[a] = factor_.get() + offsets_[static_cast<std::size_t>(i) + a];
    double* entries = batch.entries_.get();
    project_heads(rows.data(), {batch.row(0) + i, batch.stride_, count}, magnitudes + i, entries);
    for (const double*& row : rows) row += kRowGranule;
    project_block(rows.data(), {batch.row(0) + i + kGroup, batch.stride_, count},
                  width_ - static_cast<std::size_t>(i + kGroup), entries);
    for (int k = 0; k < count; ++k)
      for (int a = 0; a < kGroup; ++a) count_in(i + a, k, entries[k * kGroup + a]);
  }
  for (; i < columns_; ++i) {
    const std::size_t begin = row_begin(i);
    const double noise = calibration::rounding::kNoise * magnitudes[static_cast<std::size_t>(i)];
    for (int k = 0; k < count; ++k) {
      double* x = batch.row(k);
      const double entry = std::abs(x[i]) <= noise ? 0.0 : x[i];
      project_row(factor_.get() + offsets_[static_cast<std::size_t>(i)], x + begin, width_ - begin,
                  entry);
      x[i] = 0.0;
      count_in(i, k, entry);
    }
  }
  for (int k = 0; k < count; ++k) previews[k].error = batch.row(k)[columns_];
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

void GivensQr::archive(Archive& a) {
  // not archived: columns_, responses_, width_, offsets_, factor_size_ (construction)
  // not archived: own_ (empty between calls)
  a(weights_, magnitudes_, squares_, products_);
  for (int i = 0; i < columns_; ++i)
    a.doubles(factor_.get() + offsets_[static_cast<std::size_t>(i)],
              static_cast<std::size_t>(columns_ + responses_) - row_begin(i));
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
    const Eigen::Map<const Eigen::ArrayXd> row(entry(i, begin), end - begin);
    norms.tail(end - begin).array() += weight * row * row;
  }
  norms = norms.cwiseSqrt();
}

void GivensQr::solve(int response, int leading, Eigen::Ref<Eigen::VectorXd> coefficients) const {
  for (int i = leading - 1; i >= 0; --i) {
    const double diagonal = root(i);
    if (diagonal <= calibration::rounding::kNegligible * magnitudes_[static_cast<std::size_t>(i)]) {
      coefficients(i) = 0.0;
      continue;
    }
    const int rest = leading - 1 - i;
    const Eigen::Map<const Eigen::VectorXd> row(entry(i, i) + 1, rest);
    coefficients(i) = *entry(i, columns_ + response) - row.dot(coefficients.segment(i + 1, rest));
  }
}

}  // namespace mpm
