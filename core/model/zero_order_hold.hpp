#pragma once

#include <Eigen/Core>

#include "core/model/model_spec.hpp"

namespace mpm {

/// A transfer function sampled under a zero-order hold, n states (n >= 0):
///   x(k+1) = transition x(k) + from_newer u(k-delay) + from_older u(k-delay-1)
///   y(k+1) = output . x(k+1) + feed_through u(k-delay)
/// The feed-through (lead over one lag, or a pure gain) acts on the input just before the sampling
/// instant. A dead time of delay + f samples, 0 <= f < 1, splits the hold in two (Astrom and
/// Wittenmark 1997, section 2.6).
struct SampledLag {
  Eigen::MatrixXd transition;  ///< n x n, lower triangular
  Eigen::VectorXd from_newer;  ///< n
  Eigen::VectorXd from_older;  ///< n
  Eigen::VectorXd output;      ///< n
  double feed_through = 0.0;
  int delay = 0;  ///< whole samples
};

/// A dead time as whole samples and the fraction of one that is left, 0 <= fraction < 1. A ratio
/// such as 0.6 / 0.1 that misses a whole number by rounding is that number.
struct SampledDelay {
  int whole = 0;
  double fraction = 0.0;
};
[[nodiscard]] SampledDelay sampled_delay(double dead_time_s, double sample_time_s);

/// Exact to rounding for any time constants, also equal or very different ones.
/// Throws std::invalid_argument where the specification is not a proper, causal system.
[[nodiscard]] SampledLag sample_transfer_function(const TransferFunction& channel,
                                                  double sample_time_s);

}  // namespace mpm
