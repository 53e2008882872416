#pragma once

#include "core/identification/prediction_error.hpp"

namespace mpm {

/// p-value of the innovations being white (Ljung and Box 1978), of as many lags as the calibration
/// says beyond the order of the noise.
[[nodiscard]] double whiteness_p_value(const PredictionErrorFit& fit);

/// p-value of the innovations not depending on an input's past beyond what its channel says: the
/// score test of a channel of any dynamics beside the model (Breusch and Godfrey 1978). Small where
/// the form of a channel is too simple, the noise model too poor, or the channel not linear.
[[nodiscard]] double past_input_p_value(const IdentificationData& data,
                                        const PredictionErrorFit& fit, int input);

}  // namespace mpm
