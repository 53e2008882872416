#pragma once

#include "core/model/model_spec.hpp"

namespace mpm {

/// Plant against model, of one channel.
struct ChannelError {
  double gain_ratio = 1.0;
  double time_constant_ratio = 1.0;  ///< > 0
  double dead_time_error_s = 0.0;
  double damping_ratio = 1.0;  ///< > 0; of a filter's complex poles
};

/// The channel as it is in the plant. Transfer functions and tanks keep their form; a filter's
/// poles move to p^(1/ratio) at equal steady gain, with another damping those of a pair closer or
/// less close to the unit circle at equal frequency and its dead time by whole samples (the
/// nearest); a step response is stretched about its dead time. A dead time never becomes negative.
[[nodiscard]] ChannelSpec edited(const ChannelSpec& channel, const ChannelError& error,
                                 double sample_time_s);

/// Whether it is a filter with complex poles.
[[nodiscard]] bool rings(const ChannelSpec& channel);

/// Dead time (s) that can be taken from a channel at most.
[[nodiscard]] double removable_dead_time_s(const ChannelSpec& channel, double sample_time_s);

/// Its slowest time constant (s), at least one sample time.
[[nodiscard]] double slowest_time_constant_s(const ChannelSpec& channel, double sample_time_s);
/// The slowest of all of a CV, at least so many samples.
[[nodiscard]] double slowest_of_cv_s(const ModelSpec& model, int cv, double least_samples);

/// A model of this channel alone, without its input block, in deviations (all origins 0).
[[nodiscard]] ModelSpec alone(const ChannelSpec& channel, double sample_time_s);

/// `model` with every channel on its own: a state space becomes step responses, and filters whose
/// one pole is the integrator's where a channel integrates.
[[nodiscard]] ModelSpec in_channels(const ModelSpec& model);

}  // namespace mpm
