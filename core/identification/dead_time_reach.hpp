#pragma once

#include "core/identification/identification_data.hpp"
#include "core/identification/prediction_error.hpp"

namespace mpm {

/// Makes the s.d. of each free dead time as large as the rise of the misfit shows it to be: that
/// has a kink at every whole sample, and other minima beyond, so that its curvature at the best one
/// says too little. With the dead time held farther and farther away, and all else fitted anew, a
/// 95 % interval ends where -2 ln likelihood has risen by 3.84 (Wilks 1938). `noise`: the fit's.
void widen_dead_times(const IdentificationData& data, int cv, const NoiseAssumption& noise,
                      PredictionErrorFit& fit);

}  // namespace mpm
