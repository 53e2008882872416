#include "core/monitor/f_thresholds.hpp"

#include <cmath>

#include "core/monitor/calibration.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {

double FThresholds::at(double numerator, double denominator, int tests, double level) {
  if (numerator <= 0.0) return 0.0;
  for (Kept& kept : kept_) {
    if (kept.numerator != numerator || kept.tests != tests) continue;
    const double change = std::abs(kept.denominator - denominator);
    if (change > calibration::evaluation::kKeptThresholdShare * denominator) {
      kept.denominator = denominator;
      kept.value = f_quantile(level / tests, numerator, denominator);
    }
    return kept.value;
  }
  kept_.push_back(
      {numerator, tests, denominator, f_quantile(level / tests, numerator, denominator)});
  return kept_.back().value;
}

}  // namespace mpm
