#include "core/mismatch/coupled_cvs.hpp"

#include <algorithm>
#include <cmath>

#include "core/mismatch/calibration.hpp"
#include "core/mismatch/volterra_terms.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {

CoupledCvs::CoupledCvs(const RegressionShape& shape)
    : shape_(shape),
      lead_in_(shape.lead_in() + VolterraTerms::most_columns()),
      feed_(lead_in_ + 1),
      lags_(lead_in_, 1) {
  found_.reserve(calibration::coupled_errors::kMostCvs);
}

double CoupledCvs::p_value(const GivensQr& factor, const EstimateNoise& noise, int other) {
  const int lead_in = factor.columns() - shape_.inputs * shape_.block();
  const int begin = shape_.lags_of(other), lags = shape_.residual_order;
  lags_.clear();
  for (int r = 0; r < lead_in; ++r) {
    double* row = feed_.next_row(lags_);
    std::fill(row, row + lead_in_, 0.0);
    for (int c = r; c < lead_in; ++c) {
      const bool theirs = c >= begin && c < begin + lags;
      row[theirs ? lead_in_ - lags + c - begin : c < begin ? c : c - lags] = factor.r(r, c);
    }
    row[lead_in_] = factor.z(r, 0);
  }
  feed_.flush(lags_);
  double explained = 0.0;
  for (int r = lead_in_ - lags; r < lead_in_; ++r) explained += std::pow(lags_.z(r, 0), 2);
  return f_upper_tail(explained / (lags * noise.block_variance), lags, noise.freedom);
}

std::span<const CoupledCvs::Other> CoupledCvs::of(
    int cv, std::span<const RegressionMemory* const> memories) {
  found_.clear();
  const RegressionMemory& own = *memories[static_cast<std::size_t>(cv)];
  const EstimateNoise noise = estimate_noise(own);
  for (int other = 0; other < shape_.cvs && noise.variance > 0.0; ++other) {
    if (other == cv || memories[static_cast<std::size_t>(other)] == nullptr) continue;
    const double p = p_value(own.factor, noise, other);
    if (!(p < calibration::coupled_errors::kUncoupledPValue)) continue;
    found_.insert(std::ranges::upper_bound(found_, p, {}, &Other::p_value), {other, p});
    if (found_.size() == calibration::coupled_errors::kMostCvs) found_.pop_back();
  }
  return found_;
}

}  // namespace mpm
