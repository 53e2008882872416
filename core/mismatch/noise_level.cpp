#include "core/mismatch/noise_level.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {

namespace heavy_tails = calibration::heavy_tails;
using calibration::row_weights::kClip;
using calibration::row_weights::kLastingRows;
using calibration::row_weights::kLeastShare;
using calibration::row_weights::kMostLeverage;
using calibration::row_weights::kNewDirectionLeverage;
using calibration::row_weights::kNoiseRows;
using calibration::row_weights::kRecentRows;

void NoiseLevel::begin(double mean_square, double freedom) {
  scale_ = std::sqrt(mean_square);
  scale_rows_ = std::min(std::max(freedom, 1.0), kNoiseRows);
  known_ = true;
}

RowWeight NoiseLevel::weigh(const GivensQr::Preview& preview, bool together) {
  const double weight = 1.0 / scale_;
  const double leverage = preview.leverage * weight * weight;
  return weigh(std::abs(preview.error) * weight / std::sqrt(1.0 + leverage), leverage,
               together && leverage > kNewDirectionLeverage);
}

RowWeight NoiseLevel::weigh(double error, double leverage, bool new_direction) {
  const double clipped = std::min(error, kClip);
  const double heavy = bounded_ ? heavy_tails() : 0.0;
  const double share =
      heavy > 0.0 ? std::clamp(kMostLeverage / (heavy * leverage), kLeastShare, 1.0) : 1.0;
  RowWeight weight{std::sqrt(share) / scale_, share};
  if (error > clipped) weight.weight *= clipped / error;
  square_rows_ += 1.0;
  if (tells_of_tails(leverage))
    clipped_share_ += ((error > kClip ? 1.0 : 0.0) - clipped_share_) /
                      std::min(heavy_tails::kPriorRows + square_rows_, kLastingRows);
  if (new_direction) return weight;
  const double square = clipped * clipped * scale_ * scale_;
  recent_square_ += (square - recent_square_) / std::min(square_rows_, kRecentRows);
  lasting_square_ += (square - lasting_square_) / std::min(square_rows_, kLastingRows);
  scale_rows_ = std::min(scale_rows_ + 1.0, kNoiseRows);
  scale_ *= std::sqrt(1.0 + (clipped * clipped - 1.0) / scale_rows_);
  return weight;
}

void NoiseLevel::restart(double scale, double clipped_share) {
  scale_ = scale;
  clipped_share_ = clipped_share;
  square_rows_ = recent_square_ = lasting_square_ = 0.0;
}

double NoiseLevel::heavy_tails() const {
  const double heavy = (clipped_share_ - heavy_tails::kFromShare) /
                       (heavy_tails::kFullShare - heavy_tails::kFromShare);
  return std::clamp(heavy, 0.0, 1.0);
}

}  // namespace mpm
