#include "core/mismatch/slow_noise.hpp"

#include <algorithm>

#include "core/mismatch/calibration.hpp"

namespace mpm {

// The columns take the share few / own of the noise's variance with them, so that the error is
// few / (1 - few / own).
double slow_noise_ratio(double own, double slow_columns, double rows) {
  constexpr double kMost = calibration::few_rows::kMostSlowNoise;
  const double few = 2.0 * (slow_columns + 1.0) / rows;  // and the past itself
  const double left = own - 2.0 * few;
  return left > 0.0 ? std::min(kMost, (own - few) / left) : kMost;
}

}  // namespace mpm
