#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "config/unit_config.hpp"
#include "sim/signals/random_stream.hpp"

namespace mpm::sim {

struct SetpointSource {
  config::SetpointSettings settings;
  std::size_t leader;  ///< the CV whose signs and times it takes; its own index = none
};

/// Random binary set-points around the operating point. CV j draws +-amplitude afresh every
/// hold_samples, at k = phase_j + m hold with phase_j = j hold / n_cv, and once at k = 0.
class RandomBinarySetpoints {
 public:
  /// One source per CV. An amplitude of 0 keeps a set-point constant.
  RandomBinarySetpoints(const std::vector<SetpointSource>& sources, const Eigen::VectorXd& origin,
                        std::uint64_t seed);

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
