#pragma once

#include "core/mismatch/lagged_correlation.hpp"

namespace mpm {

/// The line that the thesis draws into its correlation figures (Carlsson 2010, 3.6.5 and chapter
/// 4): the mean of |c_ji(d)| over all channels and all lags shown, one figure for the whole unit. A
/// channel above it is "likely to be affected". It bounds no false-alarm rate: it falls with the
/// correlations themselves, so that some channel is above it whatever the data, and in a healthy
/// loop most are (docs/validation.md).
/// Over the inputs whose correlations are defined; 0 where none are. As of the last `evaluate`.
[[nodiscard]] double mean_line(const LaggedCorrelation& correlation);

}  // namespace mpm
