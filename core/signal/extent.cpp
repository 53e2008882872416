#include "core/signal/extent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mpm {

using calibration::extent::kDigits;
using calibration::extent::kOutermost;
using calibration::extent::kTooFar;

bool Extent::learn(double value) {
  if (known()) {
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
    return true;
  }
  first_[taken_++] = value;
  if (!known()) return true;
  std::sort(first_.begin(), first_.end());
  const double inner_low = first_[kOutermost], inner_high = first_[kFirst - 1 - kOutermost];
  const double level = std::abs(first_[kFirst / 2]);
  low_ = first_.front();
  high_ = first_.back();
  if (high_ - low_ <= kTooFar * std::max(inner_high - inner_low, kDigits * level)) return true;
  low_ = inner_low;
  high_ = inner_high;
  return false;
}

double Extent::width() const {
  const double width = high_ - low_;
  return width > kDigits * std::max(std::abs(low_), std::abs(high_)) ? width : 0.0;
}

double Extent::beyond(double value) const {
  const double outside = std::max({low_ - value, value - high_, 0.0});
  if (outside == 0.0) return 0.0;
  return width() > 0.0 ? outside / width() : std::numeric_limits<double>::infinity();
}

}  // namespace mpm
