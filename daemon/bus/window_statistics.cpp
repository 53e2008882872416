#include "daemon/bus/window_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mpm::bus {

void WindowStatistics::add(double value) {
  if (values_.size() == window_) values_.pop_front();
  values_.push_back(value);
}

double WindowStatistics::mean() const {
  if (values_.empty()) return 0.0;
  return std::accumulate(values_.begin(), values_.end(), 0.0) / static_cast<double>(values_.size());
}

double WindowStatistics::min() const {
  return values_.empty() ? 0.0 : *std::min_element(values_.begin(), values_.end());
}

double WindowStatistics::max() const {
  return values_.empty() ? 0.0 : *std::max_element(values_.begin(), values_.end());
}

double WindowStatistics::deviation() const {
  if (values_.empty()) return 0.0;
  const double center = mean();
  double sum = 0.0;
  for (const double value : values_) sum += (value - center) * (value - center);
  return std::sqrt(sum / static_cast<double>(values_.size()));
}

}  // namespace mpm::bus
