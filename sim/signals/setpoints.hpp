#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "config/unit_config.hpp"
#include "sim/signals/random_stream.hpp"

namespace mpm::sim {

/// Random binary set-points around the operating point. CV j draws +-amplitude afresh every
/// hold_samples, at k = phase_j + m hold with phase_j = j hold / n_cv, and once at k = 0.
class RandomBinarySetpoints {
 public:
  /// `amplitude_ratio` scales all amplitudes; 0 keeps the set-points constant.
  RandomBinarySetpoints(const std::vector<config::SetpointSettings>& settings,
                        const Eigen::VectorXd& origin, double amplitude_ratio, std::uint64_t seed);

  /// Set-points of the next interval, starting with k = 0.
  [[nodiscard]] const Eigen::VectorXd& next();

 private:
  struct Channel {
    double amplitude;
    std::int64_t hold, phase;
    RandomStream stream;
  };
  std::vector<Channel> channels_;
  Eigen::VectorXd origin_, values_;
  std::int64_t interval_ = 0;
};

}  // namespace mpm::sim
