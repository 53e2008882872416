#include "core/mismatch/input_estimates.hpp"

#include <algorithm>
#include <array>

#include "core/mismatch/calibration.hpp"
#include "core/mismatch/volterra_terms.hpp"
#include "core/regression/rotation.hpp"

namespace mpm {
namespace {

constexpr int kGranule = static_cast<int>(kRowGranule);

}  // namespace

InputEstimates::InputEstimates(const RegressionShape& shape)
    : shape_(shape), block_(shape.block()) {
  const int all = shape.inputs * block_;
  padded_ = (all + kGranule - 1) / kGranule * kGranule;
  triangle_.setZero(padded_, padded_);
  inverse_ = make_aligned(static_cast<std::size_t>(padded_) * static_cast<std::size_t>(padded_));
  norms_.setZero(all);
  scales_.setZero(all);
  rotated_.setZero(all);
  estimate_.setZero(all);
  coefficients_.setZero(shape.columns() + VolterraTerms::most_columns());
  own_past_.setZero(shape.past());
}

void InputEstimates::read(int cv, const GivensQr& factor) {
  const int all = columns();
  lead_in_ = factor.columns() - all;
  factor.centred_norms(lead_in_, norms_);
  for (int c = 0; c < all; ++c) scales_(c) = norms_(c) > 0.0 ? 1.0 / norms_(c) : 0.0;
  for (int i = 0; i < all; ++i) {
    const Eigen::Map<const Eigen::RowVectorXd> row(factor.unit_row(lead_in_ + i), all - i);
    triangle_.row(i).segment(i, all - i) =
        (factor.root(lead_in_ + i) * row).cwiseProduct(scales_.tail(all - i).transpose());
    rotated_(i) = factor.z(lead_in_ + i, 0);
  }
  invert_triangle();
  for (int i = 0; i < all; ++i)
    estimate_(i) =
        Eigen::Map<const Eigen::VectorXd>(inverse_row(i) + i, all - i).dot(rotated_.tail(all - i));
  read_own_past(cv, factor);
}

void InputEstimates::read_own_past(int cv, const GivensQr& factor) {
  double least_share = 1.0;
  for (int c = 0; c < columns(); ++c) least_share = std::min(least_share, triangle_(c, c));
  const bool separable = least_share > calibration::rounding::kSeparableShare;
  factor.solve(0, separable ? factor.columns() : lead_in_, coefficients_);
  shape_.own_past(cv, coefficients_, own_past_);
  residual_norm_ = factor.centred_norm(shape_.lags_of(cv));
}

double InputEstimates::memory(int input) const {
  const int at = input * block_;
  if (shape_.fir_lags < 2) return 1.0;
  const auto last = triangle_.col(at).head(at + 2), before = triangle_.col(at + 1).head(at + 2);
  const double norms = last.norm() * before.norm();
  const double correlation = norms > 0.0 ? std::max(0.0, last.dot(before) / norms) : 0.0;
  return 1.0 / std::max(1.0 - correlation, calibration::rounding::kSeparableShare);
}

void InputEstimates::move(int input, const Eigen::VectorXd& x,
                          Eigen::Ref<Eigen::VectorXd> out) const {
  const int at = input * block_;
  out.head(at + block_).noalias() = triangle_.block(0, at, at + block_, block_) * x;
}

double InputEstimates::movement(int input, const Eigen::VectorXd& x, Eigen::VectorXd& work) const {
  move(input, x, work);
  return work.head((input + 1) * block_).squaredNorm();
}

// A granule of rows at a time, the last ones first; what is behind them is subtracted from all of
// them in one go.
void InputEstimates::invert_triangle() {
  for (int first = padded_ - kGranule; first >= 0; first -= kGranule) {
    for (int i = first; i < first + kGranule; ++i)
      std::fill(inverse_row(i) + first, inverse_row(i) + padded_, 0.0);
    subtract_rows_behind(first);
    invert_granule(first);
  }
}

void InputEstimates::subtract_rows_behind(int first) {
  std::array<const double*, kRowGranule> rows{};
  std::array<double, kRowGranule * kRowGranule> entries{};
  const auto width = static_cast<std::size_t>(padded_);
  for (int c = first + kGranule; c < padded_; c += kGranule) {  // row c has zeros before column c
    for (int k = 0; k < kGranule; ++k) {
      rows[static_cast<std::size_t>(k)] = inverse_row(c + k) + c;
      std::copy_n(triangle_.row(first + k).data() + c, kGranule, entries.data() + k * kGranule);
    }
    project_block(rows.data(), {inverse_row(first) + c, width, kGranule},
                  static_cast<std::size_t>(padded_ - c), entries.data());
  }
}

void InputEstimates::invert_granule(int first) {
  const int all = columns();
  const int end = first + kGranule;
  for (int i = end - 1; i >= first; --i) {
    double* out = inverse_row(i);
    for (int c = i + 1; c < end; ++c)
      project_row(inverse_row(c) + c, out + c, static_cast<std::size_t>(padded_ - c),
                  triangle_(i, c));
    const bool moves = i < all && norms_(i) > 0.0;
    const double inverse =
        moves ? 1.0 / std::max(triangle_(i, i), calibration::rounding::kOwnShare) : 1.0;
    for (int k = i + 1; k < padded_; ++k) out[k] *= inverse;
    out[i] = i < all ? inverse : 0.0;
  }
}

}  // namespace mpm
