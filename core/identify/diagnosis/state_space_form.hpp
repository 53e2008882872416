#pragma once

#include <optional>

#include "core/model/model_spec.hpp"

namespace mpm {

/// A model that was given as a state space and repaired channel by channel, as a state space again:
/// the given one, with states of their own for what each repaired channel gives more or less than
/// before. A, B, C, D and x0 stand unchanged in the upper left; inputs that the repair added are
/// new columns. Every channel's step response is that of `extended` within kStateSpaceDeviation of
/// its largest value.
///
/// The difference of two channels is realised from its impulse response by the singular values of
/// its Hankel matrix, with as few states as keep that (Kung 1978).
///
/// `given` has a state space; `base` is in_channels(given), and `extended` what was made of it.
/// Nothing where a channel is no longer linear (state terms, blocks of its own, tanks) or would
/// take too many states.
[[nodiscard]] std::optional<ModelSpec> in_state_space(const ModelSpec& given, const ModelSpec& base,
                                                      const ModelSpec& extended);

}  // namespace mpm
