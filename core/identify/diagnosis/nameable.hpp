#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/identify/evidence/channel_tests.hpp"
#include "core/identify/fit/effect.hpp"

namespace mpm {

/// How the signals of a recording are numbered.
struct SignalRanges {
  int mvs = 0;     ///< of the model's inputs; the rest are DVs, which have no actuator
  int inputs = 0;  ///< of the model; aux signals are numbered after them
  int aux = 0;     ///< those after them are set-points, which are no inputs of a model
};

/// The channels that an effect changes, as (CV, input); aux signals are numbered after the inputs.
[[nodiscard]] std::vector<std::pair<int, int>> channels_of(const Effect& effect,
                                                           const ModelSpec& model,
                                                           int model_inputs);

/// Whether it is an error of one channel's gain, time constants or dead time, or of several.
[[nodiscard]] bool is_error_of_channel(const Effect& effect);

/// Whether it holds such an error of all channels of an input or of a CV alike, or of one beside a
/// state that bends: the calibrated test sees it where it can be seen at all.
[[nodiscard]] bool is_scale(const Effect& effect);

/// Which effects may be named: what acts through channels where the calibrated test rejects those
/// (`model`'s), a curve or another linear error than a channel's where what it rejects may matter:
/// in a free run errors that matter in no channel may add up, so that a CV that two inputs move
/// against one another seems to have another scale. An error of one channel may be too small to
/// matter: not taken in, another cause would explain what it does. A disturbance may be named
/// always, but for a level where channels of its CV are rejected: a gain that is off shifts it,
/// too, named or not. What a set-point does as `may_name_setpoint` says. A curve of one channel may
/// be named where one of its whole input may: only of all CVs it would bend those that are
/// straight. Any curve only where its input moves from outside the loop too (shares per input):
/// feedback bends what is straight; or wherever `nonlinear`, which asks the monitor's nonlinear
/// test, says that no linear error explains its channel: that holds under feedback. Where an input
/// moves hardly at all from there, no channel's gain or lags: to leave the channel out then
/// explains everything, for the controller holds the CV where it is. All must outlive what is
/// returned.
[[nodiscard]] std::function<bool(const Effect&)> nameable(
    const ModelSpec& model, const SignalRanges& ranges, const ChannelTests& tests,
    const ChannelTests& nonlinear, const std::vector<std::optional<double>>& outside_shares);

}  // namespace mpm
