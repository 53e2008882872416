#pragma once

#include <vector>

#include "core/identify/diagnosis/diagnosis.hpp"
#include "core/identify/evidence/channel_tests.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// The model's channels that `tests` surely rejects, by an error that matters, and that nothing
/// named or seen in `diagnosis` is about: whatever is named beside them, the model does not hold.
/// Where nothing at all is named or seen, those that it rejects as a monitor does.
[[nodiscard]] std::vector<Place> rejected_channels(const ModelSpec& model,
                                                   const ChannelTests& tests,
                                                   const Diagnosis& diagnosis);

/// Likewise those that the monitor's nonlinear test calls nonlinear.
[[nodiscard]] std::vector<Place> bent_channels(const ModelSpec& model, const ChannelTests& tests,
                                               const Diagnosis& diagnosis);

/// Of the rejected, those that the repaired model's tests reject too: the repair of something else
/// may have been all that was wrong with them.
void keep_rejected(const ChannelTests& repaired, std::vector<Place>& channels);

}  // namespace mpm
