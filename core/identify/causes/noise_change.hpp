#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/identify/fit/problem.hpp"

namespace mpm {

/// A lasting change of a CV's noise level.
struct NoiseChange {
  Eigen::Index onset = 0;  ///< row
  double ratio = 1.0;      ///< variance after over before
  double low = 1.0, high = 1.0;
  double z = 0.0;  ///< log ratio in s.d., of the best of all moments
};

/// Looks for one moment from which on the innovations are louder or quieter, by the difference of
/// the log of their robust scales against its s.d. Only what is beyond doubt and at least `least`
/// times more or less.
[[nodiscard]] std::optional<NoiseChange> find_noise_change(const CvFit& fit, const CvData& data,
                                                           double least = 1.6);

}  // namespace mpm
