#pragma once

#include <vector>

namespace mpm::report {

/// Power spectral density over frequencies spaced evenly on a log scale.
struct Spectrum {
  std::vector<double> frequency;  ///< 1/s
  std::vector<double> density;    ///< one-sided, units^2 s; NaN where nothing is known
};

/// Welch's estimate: Hann windows that overlap by half, each without its mean, averaged; then
/// averaged again within each step of frequency. Unknown values (NaN) count as the window's mean;
/// windows with more than a fifth of them are left out. Empty where no window is left.
[[nodiscard]] Spectrum welch(const std::vector<double>& values, double sample_time_s);

}  // namespace mpm::report
