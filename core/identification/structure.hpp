#pragma once

#include <optional>
#include <vector>

#include "core/identification/prediction_error.hpp"
#include "core/identification/start_values.hpp"

namespace mpm {

/// First-order channels of one CV: from each of `starts` (at least one), what the data do not need
/// goes, what is missing comes by the search; the better outcome (BIC).
[[nodiscard]] PredictionErrorFit simplest_structure(const IdentificationData& data, int cv,
                                                    const StartSearch& search,
                                                    std::vector<std::vector<ChannelShape>> starts,
                                                    const NoiseAssumption& noise);

/// Forms that become richer where that pays (BIC), one at a time: the first entry is `simplest`,
/// each other one has one form changed. Where all of them with lags that they share
/// (`StartSearch::with_shared_lags`), and what of that the data need, are better than the last,
/// these are one more.
[[nodiscard]] std::vector<PredictionErrorFit> grown_structures(const IdentificationData& data,
                                                               int cv, const StartSearch& search,
                                                               PredictionErrorFit simplest,
                                                               const NoiseAssumption& noise);

/// Without channels that the data do not need: none is left of which the likelihood ratio does not
/// say that it is there.
[[nodiscard]] PredictionErrorFit pruned(const IdentificationData& data, int cv,
                                        PredictionErrorFit fit, const NoiseAssumption& noise);

/// Fall of -2 ln likelihood that each channel of a fit is worth.
[[nodiscard]] std::vector<double> worth_of_channels(const IdentificationData& data, int cv,
                                                    const PredictionErrorFit& fit,
                                                    const NoiseAssumption& noise);

/// s.d. of each free number of channel `which`, in the order of free_numbers().
[[nodiscard]] Eigen::VectorXd sd_of(const PredictionErrorFit& fit, std::size_t which);

}  // namespace mpm
