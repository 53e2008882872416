#pragma once

#include <Eigen/Core>
#include <optional>

namespace mpm {

/// Levels that a sensor does not read beyond: its largest or smallest value, returned again and
/// again as no noisy signal does. Where a CV clips, its true value is unknown.
struct Plateaus {
  std::optional<double> low, high;
  double low_share = 0.0, high_share = 0.0;  ///< of the samples
  double tie = 0.0;                          ///< values that differ by no more are one

  /// Whether a value lies on or beyond one of them.
  [[nodiscard]] bool hold(double value) const {
    return (low && value <= *low + tie) || (high && value >= *high - tie);
  }
};

/// An end of the range that at least 0.5 % of the samples (and eight) share exactly, and five times
/// more of them than share any of the ten values next to it (a coarse converter repeats all
/// values), and that the CV comes to at twice or more: one that rests there does not clip.
[[nodiscard]] Plateaus find_plateaus(const Eigen::Ref<const Eigen::VectorXd>& values);

}  // namespace mpm
