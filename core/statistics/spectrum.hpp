#pragma once

#include <span>
#include <vector>

namespace mpm {

/// Power spectral density over frequencies spaced evenly on a log scale.
struct Spectrum {
  std::vector<double> frequency;  ///< 1/s
  std::vector<double> density;    ///< one-sided, units^2 s; NaN where nothing is known
};

/// Welch's (1967) estimate: Hann windows that overlap by half, each without its mean, averaged;
/// then averaged again within each step of frequency. Unknown values (NaN) count as the window's
/// mean; windows with more than a fifth of them are left out. Empty where no window is left.
[[nodiscard]] Spectrum welch(std::span<const double> values, double sample_time_s);

}  // namespace mpm
