#include "core/identify/diagnosis/validation.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/identify/diagnosis/calibration.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

double mean_of_finite(const Eigen::Ref<const VectorXd>& values) {
  double sum = 0.0, count = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) sum += value, ++count;
  return sum > 0.0 ? sum / count : 1.0;
}

double rms_of_squares(const Eigen::Ref<const VectorXd>& squares) {
  double sum = 0.0, count = 0.0;
  for (const double square : squares)
    if (std::isfinite(square)) sum += square, ++count;
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

CvScore score_errors(const Eigen::Ref<const VectorXd>& before,
                     const Eigen::Ref<const VectorXd>& after, Index block, std::uint64_t seed) {
  // Running sums make any block's sum two look-ups.
  std::vector<double> old_running = {0.0}, new_running = {0.0};
  for (Index k = 0; k < before.size(); ++k) {
    if (!std::isfinite(before(k)) || !std::isfinite(after(k))) continue;
    old_running.push_back(old_running.back() + before(k));
    new_running.push_back(new_running.back() + after(k));
  }
  CvScore result;
  const std::size_t count = old_running.size() - 1;
  if (count == 0) return result;
  const auto n = static_cast<double>(count);
  result.rmse_before = std::sqrt(old_running.back() / n);
  result.rmse_after = std::sqrt(new_running.back() / n);
  if (!(old_running.back() > 0.0)) return result;
  const auto length = std::clamp<std::size_t>(static_cast<std::size_t>(block), 1,
                                              std::max<std::size_t>(1, count / 4));
  const std::size_t blocks = (count + length - 1) / length;
  std::mt19937_64 random(seed);
  std::vector<double> gains;
  for (int i = 0; i < kResamples; ++i) {
    double old_draw = 0.0, new_draw = 0.0;
    for (std::size_t b = 0; b < blocks; ++b) {
      // The remainder is even enough here, and the same on every platform.
      const auto begin = static_cast<std::size_t>(random() % (count - length + 1));
      old_draw += old_running[begin + length] - old_running[begin];
      new_draw += new_running[begin + length] - new_running[begin];
    }
    gains.push_back(1.0 - std::sqrt(new_draw / std::max(1e-300, old_draw)));
  }
  std::sort(gains.begin(), gains.end());
  result.gain_low = gains[static_cast<std::size_t>(kTail * kResamples)];
  result.gain_high = gains[static_cast<std::size_t>((1.0 - kTail) * kResamples)];
  return result;
}

CvScore score(const Eigen::Ref<const VectorXd>& measured, const Eigen::Ref<const VectorXd>& before,
              const Eigen::Ref<const VectorXd>& after, Index block, std::uint64_t seed) {
  const VectorXd old_errors = (measured - before).cwiseAbs2();
  const VectorXd new_errors = (measured - after).cwiseAbs2();
  CvScore result = score_errors(old_errors, new_errors, block, seed);
  double mean = 0.0, spread = 0.0, count = 0.0, level = 0.0, compared = 0.0;
  for (Index k = 0; k < measured.size(); ++k) {
    if (!std::isfinite(measured(k))) continue;
    mean += measured(k);
    ++count;
    if (!std::isfinite(after(k))) continue;
    level += measured(k) - after(k);
    ++compared;
  }
  mean /= std::max(1.0, count);
  result.level_after = level / std::max(1.0, compared);
  for (const double value : measured)
    if (std::isfinite(value)) spread += (value - mean) * (value - mean);
  if (spread > 0.0) {
    result.fit_before = 100.0 * (1.0 - result.rmse_before / std::sqrt(spread / count));
    result.fit_after = 100.0 * (1.0 - result.rmse_after / std::sqrt(spread / count));
  }
  return result;
}

}  // namespace mpm
