#pragma once

#include <vector>

#include "core/identify/fit/problem.hpp"

namespace mpm {

/// `time_constant` (samples) is that of a lag which the step goes through, `decay` that with which
/// it passes; 0: neither.
struct StepForm {
  double time_constant = 0.0;
  double decay = 0.0;
};

/// The rows from which on a step would explain most of the innovations of `fit`, best first, no
/// two within a few rows. Every row is tried: whitening makes a step a pulse, which a coarser
/// search would miss.
[[nodiscard]] std::vector<Eigen::Index> step_moments(const CvData& data, const CvFit& fit,
                                                     const StepForm& form, std::size_t most);

}  // namespace mpm
