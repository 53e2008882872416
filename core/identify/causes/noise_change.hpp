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
  /// How many times larger the s.d. is than of levels that know nothing of each other; at least 1.
  double burstiness = 1.0;

  /// Whether more than bursts.
  [[nodiscard]] bool beyond_doubt() const;
};

/// Looks for one moment from which on the innovations are louder or quieter, by the difference of
/// the log of their robust scales against its s.d. Only what is at least `least` times more or less
/// and would be beyond doubt if there were no bursts.
[[nodiscard]] std::optional<NoiseChange> find_noise_change(const CvFit& fit, const CvData& data,
                                                           double least = 1.6);

}  // namespace mpm
