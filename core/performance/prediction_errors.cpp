#include "core/performance/prediction_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace mpm {
namespace {

double root_mean(double squares, std::int64_t count) {
  return count > 0 ? std::sqrt(squares / static_cast<double>(count))
                   : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

void PredictionSums::add(const PredictionSums& other) {
  pairs += other.pairs;
  error_square += other.error_square;
  movement_square += other.movement_square;
}

double PredictionSums::rmse() const { return root_mean(error_square, pairs); }
double PredictionSums::movement_rms() const { return root_mean(movement_square, pairs); }

PredictionErrors::PredictionErrors(int cvs, std::vector<std::int64_t> horizons)
    : cvs_(static_cast<std::size_t>(cvs)),
      rows_(static_cast<std::size_t>(*std::max_element(horizons.begin(), horizons.end()))),
      horizons_(std::move(horizons)),
      ring_(rows_ * cvs_) {}

void PredictionErrors::forget() {
  std::fill(ring_.begin(), ring_.end(), CvReading());
  begun_ = false;
}

void PredictionErrors::skip_to(std::int64_t interval) {
  const auto most = static_cast<std::int64_t>(rows_);
  const std::int64_t missing =
      begun_ ? std::clamp<std::int64_t>(interval - interval_ - 1, 0, most) : 0;
  for (std::int64_t k = 0; k < missing; ++k) remember({});
  begun_ = true;
  interval_ = interval;
}

void PredictionErrors::remember(std::span<const CvReading> readings) {
  const auto row = ring_.begin() + static_cast<std::ptrdiff_t>(place_ * cvs_);
  if (readings.empty())
    std::fill_n(row, cvs_, CvReading());
  else
    std::copy_n(readings.begin(), cvs_, row);
  place_ = (place_ + 1) % rows_;
}

}  // namespace mpm
