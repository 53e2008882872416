#include "daemon/report/page/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace mpm::report {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kShortest = 32;
constexpr std::size_t kLongest = 2048;
constexpr std::size_t kWindows = 8;  // wanted at least, before overlapping
constexpr double kMissing = 0.2;
constexpr double kStepsPerDecade = 12.0;

/// In place, for a power of two (Cooley and Tukey 1965).
void transform(std::vector<Complex>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; (j & bit) != 0; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (std::size_t length = 2; length <= n; length *= 2) {
    const Complex step = std::polar(1.0, -2.0 * std::numbers::pi / static_cast<double>(length));
    for (std::size_t start = 0; start < n; start += length) {
      Complex turn = 1.0;
      for (std::size_t i = start; i < start + length / 2; ++i) {
        const Complex odd = turn * x[i + length / 2];
        x[i + length / 2] = x[i] - odd;
        x[i] += odd;
        turn *= step;
      }
    }
  }
}

std::size_t window_length(std::size_t samples) {
  std::size_t length = kLongest;
  while (length > kShortest && length * kWindows > samples) length /= 2;
  return length;
}

/// The window without its mean, weighed; false where too little of it is known.
bool take(const double* values, std::vector<Complex>& window) {
  const std::size_t n = window.size();
  double sum = 0.0;
  std::size_t known = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (std::isfinite(values[i])) {
      sum += values[i];
      ++known;
    }
  if (static_cast<double>(n - known) > kMissing * static_cast<double>(n)) return false;
  const double mean = sum / static_cast<double>(known);
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
    const double hann = 0.5 - 0.5 * std::cos(turn);
    window[i] = std::isfinite(values[i]) ? hann * (values[i] - mean) : 0.0;
  }
  return true;
}

/// Means over frequencies that share a step of the log scale.
Spectrum on_log_scale(const std::vector<double>& power, double spacing) {
  Spectrum spectrum;
  double step = std::numeric_limits<double>::quiet_NaN();
  double frequency_sum = 0.0, power_sum = 0.0, count = 0.0;
  const auto close = [&] {
    if (count == 0.0) return;
    spectrum.frequency.push_back(frequency_sum / count);
    spectrum.density.push_back(power_sum / count);
    frequency_sum = power_sum = count = 0.0;
  };
  for (std::size_t i = 1; i < power.size(); ++i) {
    const double frequency = static_cast<double>(i) * spacing;
    const double here = std::floor(kStepsPerDecade * std::log10(static_cast<double>(i)));
    if (here != step) close();
    step = here;
    frequency_sum += frequency;
    power_sum += power[i];
    count += 1.0;
  }
  close();
  return spectrum;
}

}  // namespace

Spectrum welch(const std::vector<double>& values, double sample_time_s) {
  const std::size_t length = window_length(values.size());
  std::vector<Complex> window(length);
  std::vector<double> power(length / 2 + 1, 0.0);
  double windows = 0.0;
  for (std::size_t start = 0; start + length <= values.size(); start += length / 2) {
    if (!take(values.data() + start, window)) continue;
    transform(window);
    windows += 1.0;
    for (std::size_t i = 0; i < power.size(); ++i) power[i] += std::norm(window[i]);
  }
  if (windows == 0.0) return {};
  // sum of the Hann weights' squares = 3/8 length; the other half of the spectrum folds in.
  const double scale = 2.0 * sample_time_s / (windows * 0.375 * static_cast<double>(length));
  for (double& each : power) each *= scale;
  return on_log_scale(power, 1.0 / (static_cast<double>(length) * sample_time_s));
}

}  // namespace mpm::report
