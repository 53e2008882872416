#pragma once

#include "core/identification/identification.hpp"
#include "core/identify/fit/condense.hpp"

namespace mpm {

struct LongIdentification {
  Condensed data;  ///< what the model was made from, with its own sample time
  Identification identification;
};

/// identify() on a recording of any length. Of one that is too long, the stretches in which most
/// moves are used, their rows averaged as far as the plant is slow for it; how slow it is a first
/// look at few rows of all of the recording tells. CVs that are read seldom by their readings
/// (`identify_readings`).
[[nodiscard]] LongIdentification identify_long(const Recording& recording,
                                               const IdentificationSettings& settings);

/// The channels that were identified and the operating point, at another sample time.
[[nodiscard]] ModelSpec model_at(const Identification& identification, double sample_time_s);

}  // namespace mpm
