#pragma once

#include <vector>

#include "core/identification/form_choice.hpp"

namespace mpm {

/// The channels of a CV with one input more, or with it in the place of one.
struct RivalFit {
  PredictionErrorFit fit;
  int input = -1;
  int in_place_of = -1;  ///< an input; -1: none
};

/// A fit once more beside each of `inputs`, which it does not have and of which the data do not say
/// that they do nothing, one at a time; and with that input in a channel's place, where the
/// likelihood is about as high: where inputs move alike, what one does is easily laid to another
/// (Madigan and Raftery 1994: all models that fit about as well are to be heard).
/// `hints`: one per input. `model`: sound.
[[nodiscard]] std::vector<RivalFit> rival_fits(const Material& material,
                                               const HighOrderModel& model,
                                               const std::vector<ChannelHint>& hints, int cv,
                                               const PredictionErrorFit& fit,
                                               const NoiseAssumption& noise,
                                               const std::vector<int>& inputs);

}  // namespace mpm
