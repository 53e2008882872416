#pragma once

#include <vector>

/// Where a residual is large: over time and over the operating range. Unknown values are NaN.
namespace mpm::report {

/// Root mean square of the known values; NaN where there is none.
[[nodiscard]] double rms(const double* values, std::size_t count);

/// RMS in consecutive blocks of `block` samples, the last one perhaps shorter.
[[nodiscard]] std::vector<double> block_rms(const std::vector<double>& values, std::size_t block);

/// The range of a signal cut so that every part holds as many samples.
struct LevelBins {
  std::vector<double> level;              ///< mean of the signal in each part, growing
  std::vector<std::vector<int>> samples;  ///< the rows of each part
};
[[nodiscard]] LevelBins level_bins(const std::vector<double>& level, std::size_t parts);
/// Mean and RMS of the values in each part.
struct LevelView {
  std::vector<double> rms, mean;
};
[[nodiscard]] LevelView over_levels(const LevelBins& bins, const std::vector<double>& values);

}  // namespace mpm::report
