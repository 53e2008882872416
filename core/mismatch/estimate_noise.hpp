#pragma once

#include "core/mismatch/calibration.hpp"
#include "core/mismatch/regression_memory.hpp"

namespace mpm {

/// By how much F is too large in a regression on its own past, >= 1, in the directions of the usual
/// errors and over a whole block. `c`: columns per degree of freedom.
[[nodiscard]] constexpr double directed_inflation(double c) {
  return 1.0 + c * (calibration::few_rows::kDirected + c * calibration::few_rows::kDirectedSquare);
}
[[nodiscard]] constexpr double block_inflation(double c) {
  return 1.0 + c * (calibration::few_rows::kBlock + c * calibration::few_rows::kBlockSquare);
}

/// How much the estimates of a regression scatter: the variance of a coefficient of which the
/// covariance factor has norm 1, and its degrees of freedom. Forgetting makes the estimate noisier
/// than equal weights would: the residual variance is multiplied by W2 / W1 and has
/// W1^2 / W2 - columns degrees of freedom. Few rows of a regression on its own past add to it, more
/// in the directions of the usual errors than over a whole block.
struct EstimateNoise {
  double variance = 0.0;  ///< in single directions
  double block_variance = 0.0;
  double freedom = 0.0;
};
[[nodiscard]] EstimateNoise estimate_noise(const RegressionMemory& memory);

}  // namespace mpm
