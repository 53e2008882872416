#pragma once

#include <span>
#include <vector>

namespace mpm {

/// How a residual goes with an input some samples earlier.
struct CrossCorrelation {
  int first_lag = 0;           ///< samples; positive: the input came first
  std::vector<double> values;  ///< one per lag; empty where the input does not move
  double bound = 0.0;          ///< 2 / sqrt(pairs): beyond it by chance at one lag in twenty
};

/// Both are first filtered so that the input is white (Box and Jenkins 1976, 11.2): only then does
/// the bound hold, and the values are, but for scale, the impulse response of the model's error.
/// As many values of either, one per sample; unknown ones are NaN.
[[nodiscard]] CrossCorrelation cross_correlation(std::span<const double> input,
                                                 std::span<const double> residual, int first_lag,
                                                 int last_lag);

}  // namespace mpm
