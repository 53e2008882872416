#include "core/mismatch/estimate_noise.hpp"

#include "core/mismatch/calibration.hpp"

namespace mpm {

EstimateNoise estimate_noise(const RegressionMemory& memory) {
  const double freedom = memory.freedom();
  const double variance = memory.factor.residual_square(0) / memory.weight_sum *
                          (freedom + memory.factor.columns()) / freedom;
  const double inflated = variance * memory.weight_square / memory.weight_sum;
  const double per_freedom = memory.factor.columns() / freedom;
  return {inflated * directed_inflation(per_freedom), inflated * block_inflation(per_freedom),
          freedom};
}

}  // namespace mpm
