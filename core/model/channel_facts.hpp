#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace mpm {

/// What is known of one channel without simulating it.
struct ChannelFacts {
  bool exists = false;
  bool integrating = false;
  bool unstable = false;
  double gain = 0.0;       ///< steady state, or slope per sample where integrating
  double slowest = 1.0;    ///< samples
  double dead_time = 0.0;  ///< samples
  Eigen::Index order = 0;  ///< number of states behind the slowest time constant
};

/// Time constant in samples of the largest pole radius of a stable part.
[[nodiscard]] inline double slowest_from_radius(double radius) {
  return radius <= 0.0 ? 1.0 : std::max(1.0, -1.0 / std::log(radius));
}

}  // namespace mpm
