#pragma once

#include "core/model/model_spec.hpp"
#include "core/monitor/settings.hpp"

namespace mpm {

/// What the monitor of a unit takes: estimates to about a factor of two (docs/validation.md,
/// speed), of any unit, however absurd.
struct MonitorCost {
  double columns = 0.0;     ///< of the regression of each CV
  double remembered = 0.0;  ///< samples
  double bytes = 0.0;
  double seconds = 0.0;          ///< a sample, on one core
  double seconds_alarmed = 0.0;  ///< while a channel of each CV is wrong, at most
};

/// `spec` is a possible model, or has no channels.
[[nodiscard]] MonitorCost monitor_cost(const ModelSpec& spec, const MonitorSettings& settings);

}  // namespace mpm
