#pragma once

#include <optional>

#include "core/model/model_spec.hpp"

namespace mpm {

struct ReducedStepResponse {
  TransferFunction dynamics;
  double deviation = 0.0;  ///< largest at any sample, share of the largest coefficient
};

/// A step response (per sample, finite values, not all 0) as gain, dead time and up to two time
/// constants, with a lead or without; or, where none of these will do, as an integrator with up to
/// one: the simplest that `LinearModel` simulates within 1 % of the largest
/// coefficient at every sample, unless a
/// richer one is ten times as near. One that does not integrate also has to settle where the
/// response holds its last value. Numbers have four digits. Nothing where none is near enough, or
/// where the values are too few to tell.
[[nodiscard]] std::optional<ReducedStepResponse> reduce_step_response(const StepResponse& response,
                                                                      double sample_time_s);

}  // namespace mpm
