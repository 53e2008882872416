#pragma once

#include <vector>

namespace mpm::report {

/// How a residual goes with an input some samples earlier.
struct LagCorrelation {
  int first_lag = 0;           ///< samples; positive: the input came first
  std::vector<double> values;  ///< one per lag; empty where the input does not move
  double bound = 0.0;          ///< 2 / sqrt(pairs): beyond it by chance at one lag in twenty
};

/// Both are first filtered so that the input is white (Box and Jenkins): only then does the bound
/// hold, and the values are, but for scale, the impulse response of the model's error. Unknown
/// values are NaN.
[[nodiscard]] LagCorrelation lag_correlation(const std::vector<double>& input,
                                             const std::vector<double>& residual, int first_lag,
                                             int last_lag);

}  // namespace mpm::report
