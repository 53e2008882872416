#pragma once

#include <vector>

#include "config/scenario_config.hpp"

namespace mpm::sim {

/// A scenario's change to one channel, by indices. Plant against model.
struct ChannelChange {
  int cv = 0;
  int input = 0;
  double gain_ratio = 1.0;
  double time_constant_ratio = 1.0;
  double dead_time_error_s = 0.0;
  double from_s = 0.0;
  double until_s = config::kForEver;
};

/// One entry per channel that a change means; a missing CV or MV stands for all that have one.
/// Throws std::invalid_argument on unknown tags and where no channel is meant.
[[nodiscard]] std::vector<ChannelChange> resolve_changes(const std::vector<config::Change>& changes,
                                                         const config::UnitConfig& unit);

/// `model` with the changes applied one after the other. A transfer function and tanks keep their
/// form, and so do a filter, a step response or a state space where the change allows; else the
/// channel becomes a step response, stretched about its dead time. Throws std::invalid_argument
/// where a change is impossible (a negative dead time, an integrating channel in a form that cannot
/// be stretched).
[[nodiscard]] ModelSpec changed_model(const ModelSpec& model,
                                      const std::vector<ChannelChange>& changes);

/// Whether the model has this channel, in whatever form.
[[nodiscard]] bool has_channel(const ModelSpec& model, int cv, int input);

}  // namespace mpm::sim
