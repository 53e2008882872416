#pragma once

#include <optional>

#include "core/performance/calibration.hpp"

namespace mpm {

/// The limits that a controller keeps a signal within, in its units; low < high where both are
/// known.
struct SignalLimits {
  std::optional<double> low, high;

  [[nodiscard]] bool known() const { return low || high; }
  [[nodiscard]] bool at_low(double value) const { return low && value <= *low + reach(); }
  [[nodiscard]] bool at_high(double value) const { return high && value >= *high - reach(); }
  [[nodiscard]] bool outside(double value) const {
    return (low && value < *low) || (high && value > *high);
  }

 private:
  [[nodiscard]] double reach() const {
    return low && high ? calibration::performance::kAtLimitShare * (*high - *low) : 0.0;
  }
};

}  // namespace mpm
