#pragma once

#include <Eigen/Core>
#include <vector>

namespace mpm {

/// How regularly a signal swings (Thornhill, Huang and Zhang, J. Process Control 13, 2003): from
/// the intervals between zero crossings of its autocorrelation, in which noise is at lag 0 only.
struct Oscillation {
  double period = 0.0;      ///< samples; 0 = no interval at all
  double regularity = 0.0;  ///< r = T / (3 s.d. of the intervals' periods); regular above 1
};
/// `values` finite, at least 2.
[[nodiscard]] Oscillation oscillation_of(const Eigen::Ref<const Eigen::VectorXd>& values);

/// A signal less its mean over one `period` (samples, > 1) around each sample: what swings, without
/// what drifts.
[[nodiscard]] Eigen::VectorXd swing_of(const Eigen::Ref<const Eigen::VectorXd>& values,
                                       double period);

/// From one zero crossing to the next.
struct HalfCycle {
  double begin = 0.0, end = 0.0;  ///< samples, between which the signal has one sign
};
/// Those of a swing that last 0.25 to 0.75 of a period; noise around zero makes none.
[[nodiscard]] std::vector<HalfCycle> half_cycles(const Eigen::Ref<const Eigen::VectorXd>& swing,
                                                 double period);

}  // namespace mpm
