#pragma once

#include <vector>

#include "core/mismatch/regression_history.hpp"
#include "core/mismatch/signature.hpp"
#include "core/model/linear_model.hpp"

namespace mpm {

/// What errors of one channel's model do to the coefficients of its block.
struct ChannelSignatures {
  /// Of the usual errors: a gain error of 100 % first, then one of the time constants, then of the
  /// dead time. Where the model has no channel, 100 % alone: a first-order lag with the slowest
  /// tail and gain 1.
  std::vector<Signature> errors;
  std::vector<Signature> shifts;  ///< one sample later, one earlier, minus the response itself
  /// Steady gain (integrating: rise in the slowest tail's time constant); 0 = no channel.
  double gain = 0.0;
  /// Where the model has no channel, the gain that one would have if the model's gains were
  /// products of what each input and each CV is like: the median of |g(j',i) g(j,i') / g(j',i')|,
  /// so free of units. 0 where its other channels do not say.
  double usual_gain = 0.0;
};

/// Of all channels of the model, input-major.
[[nodiscard]] std::vector<ChannelSignatures> channel_signatures(const RegressionShape& shape,
                                                                const LinearModel& model);

}  // namespace mpm
