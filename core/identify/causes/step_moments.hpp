#pragma once

#include <vector>

#include "core/identify/fit/problem.hpp"

namespace mpm {

/// The rows from which on a step would explain most of the innovations of `fit`, best first, no
/// two within a few rows. Every row is tried: whitening makes a step a pulse, which a coarser
/// search would miss. `time_constant` (samples) is that of a lag which the step goes through, 0 =
/// none.
[[nodiscard]] std::vector<Eigen::Index> step_moments(const CvData& data, const CvFit& fit,
                                                     double time_constant, std::size_t most);

}  // namespace mpm
