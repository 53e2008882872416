#pragma once

#include <vector>

#include "core/identification/channel_hint.hpp"
#include "core/identification/channel_shape.hpp"
#include "core/identification/high_order.hpp"

namespace mpm {

/// First-order channels of one CV, near enough for Gauss-Newton to end at the right minimum: the
/// regression of high order is asked which lag and dead time on a grid explain most of it, first
/// with all other inputs free to do anything (so that no wrong guess of theirs matters), then with
/// the others as they were found, several times over. `hints`: one per input, of this CV.
/// What explains next to nothing is not among them.
[[nodiscard]] std::vector<ChannelShape> start_values(const HighOrderModel& model,
                                                     const std::vector<ChannelHint>& hints,
                                                     double sample_time_s);

/// How much (relative to 0) the gain of an input would have to be to show at all, all other inputs
/// free: s.d. of the gain of a first-order channel of the given speed (samples). Infinite where the
/// others' past, or the CV's own, explains the input.
[[nodiscard]] double gain_sd(const HighOrderModel& model, int input, double time_constant);

}  // namespace mpm
