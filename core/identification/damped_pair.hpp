#pragma once

#include "core/model/model_spec.hpp"

namespace mpm {

/// 1 / (time^2 s^2 + 2 damping time s + 1), which overshoots.
struct DampedPair {
  double time = 1.0;     ///< of the undamped oscillation, over 2 pi; > 0
  double damping = 0.5;  ///< 0 < damping < 1
};

/// Answer to a unit step, `since` it came; 0 before it.
[[nodiscard]] double step_response(const DampedPair& pair, double since);

/// With a gain behind a dead time, sampled under a zero-order hold; all times in the same unit.
/// A fraction of a sample in the dead time costs a third coefficient (Astrom and Wittenmark 1997,
/// section 2.6).
[[nodiscard]] DiscreteFilter sampled(const DampedPair& pair, double gain, double dead_time,
                                     double sample_time);

}  // namespace mpm
