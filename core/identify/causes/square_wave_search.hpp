#pragma once

#include <cstddef>
#include <vector>

#include "core/identify/fit/problem.hpp"
#include "core/parallel/parallel.hpp"

namespace mpm {

/// +1, -1, +1, ... each for half a period; rows.
struct SquareWave {
  double gain = 0.0;                 ///< fall of the misfit over the noise's variance
  double begin = 0.0, period = 0.0;  ///< of one of its rising edges
  Eigen::Index onset = 0;            ///< there is none before
};

struct SquareWaves {
  std::vector<SquareWave> waves;  ///< the best few of each onset, no two of nearly one period
  std::size_t looked_at = 0;      ///< how many they were picked from
};

/// Disturbances that switch to and fro, as a limit cycle elsewhere does: the best of all periods
/// and phases. In the innovations they are pulses, which no periodogram shows.
[[nodiscard]] SquareWaves find_square_waves(const CvData& data, const CvFit& without,
                                            const Parallel& parallel = one_thread());

}  // namespace mpm
