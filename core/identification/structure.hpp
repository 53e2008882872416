#pragma once

#include <optional>
#include <vector>

#include "core/identification/prediction_error.hpp"

namespace mpm {

/// The channels of one CV, from those given: what the data do not need goes, then forms become
/// richer where that pays (BIC), one at a time. Each entry is the fit before a change and after it:
/// the first has the simplest forms, the last the richest.
[[nodiscard]] std::vector<PredictionErrorFit> grown_structures(const IdentificationData& data,
                                                               int cv,
                                                               std::vector<ChannelShape> channels,
                                                               const NoiseModel& noise);

/// Without channels that the data do not need: none is left of which the likelihood ratio does not
/// say that it is there.
[[nodiscard]] PredictionErrorFit pruned(const IdentificationData& data, int cv,
                                        PredictionErrorFit fit, const NoiseModel& noise);

/// Fall of -2 ln likelihood that each channel of a fit is worth.
[[nodiscard]] std::vector<double> worth_of_channels(const IdentificationData& data, int cv,
                                                    const PredictionErrorFit& fit,
                                                    const NoiseModel& noise);

/// s.d. of each free number of channel `which`, in the order of free_numbers().
[[nodiscard]] Eigen::VectorXd sd_of(const PredictionErrorFit& fit, std::size_t which);

}  // namespace mpm
